#pragma once

#include <memory>
#include <petscksp.h>
#include <type_traits>

/// Owning handles for the PETSc objects this folder uses, and its error codes as exceptions.
namespace springproof::fem_reference {

/// @throws std::runtime_error with PETSc's message for a non-zero code: a programming or memory error, never
/// a solver that failed to converge
void check(PetscErrorCode code);

struct DestroyVector {
  void operator()(Vec v) const { VecDestroy(&v); }
};
struct DestroyMatrix {
  void operator()(Mat m) const { MatDestroy(&m); }
};
struct DestroySolver {
  void operator()(KSP k) const { KSPDestroy(&k); }
};
struct DestroyNullSpace {
  void operator()(MatNullSpace n) const { MatNullSpaceDestroy(&n); }
};

using Vector = std::unique_ptr<std::remove_pointer_t<Vec>, DestroyVector>;
using Matrix = std::unique_ptr<std::remove_pointer_t<Mat>, DestroyMatrix>;
using Solver = std::unique_ptr<std::remove_pointer_t<KSP>, DestroySolver>;
using NullSpace = std::unique_ptr<std::remove_pointer_t<MatNullSpace>, DestroyNullSpace>;

/// A vector of the same layout, zero.
Vector like(const Vector& vector);

} // namespace springproof::fem_reference
