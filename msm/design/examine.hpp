#pragma once

#include "msm/design/linear_method.hpp"

#include <string>
#include <vector>

/// Whether the springs of a cell can be trusted at rest.
namespace springproof::msm {

/// Eigenvalues of a cell's tangent at rest that are no round-off.
struct Signs {
  Eigen::Index n_negative, n_zero;
};

Signs signs_at_rest(const CellMatrix& matrix);

/// Reasons not to trust a cell: negative stiffnesses, a mechanism (more than the six rigid modes), an
/// indefinite tangent at rest.
std::vector<std::string> examine(const CellStiffness& stiffness, const CellVertices& vertices);

/// The same of cells of terms, whose kinds are mirror images.
std::vector<std::string> examine(const CellTerms& terms, const CellVertices& vertices);

} // namespace springproof::msm
