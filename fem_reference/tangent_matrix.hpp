#pragma once

#include "fem_reference/constraints.hpp"

namespace springproof::fem_reference {

/// A matrix with the sparsity of the tangent, zero, that takes values at local degrees of freedom. Rows and
/// columns of constrained degrees of freedom have their diagonal alone.
Matrix make_tangent_matrix(const Space& space, const Nodes& nodes, const Constraints& constraints);

} // namespace springproof::fem_reference
