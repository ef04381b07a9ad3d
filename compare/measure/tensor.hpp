#pragma once

#include "cases/case/case.hpp"
#include "cases/case/solution.hpp"

namespace springproof::compare {

/// A component of a symmetric tensor, its von Mises equivalent or a principal value, in the tensor's unit.
double component_of(const cases::SymmetricTensor& tensor, cases::TensorComponent component);

/// sqrt(3/2 dev(sigma) : dev(sigma))
double von_mises(const cases::SymmetricTensor& tensor);

/// sqrt(sigma : sigma)
double tensor_norm(const cases::SymmetricTensor& tensor);

} // namespace springproof::compare
