#pragma once

#include <memory>
#include <petscsnes.h>
#include <type_traits>

/// Owning handles for PETSc's objects, and its error codes as exceptions.
namespace springproof::mechanics::petsc {

/// @throws std::runtime_error with PETSc's message for a non-zero code: a programming or memory error, never
/// a solver that failed to converge
void check(PetscErrorCode code);

template<class Object, PetscErrorCode (*destroy)(Object*)>
struct Destroy {
  void operator()(Object object) const { destroy(&object); }
};
template<class Object, PetscErrorCode (*destroy)(Object*)>
using Owned = std::unique_ptr<std::remove_pointer_t<Object>, Destroy<Object, destroy>>;

using Vector = Owned<Vec, VecDestroy>;
using Matrix = Owned<Mat, MatDestroy>;
using NullSpace = Owned<MatNullSpace, MatNullSpaceDestroy>;
using LinearSolver = Owned<KSP, KSPDestroy>;
using NonlinearSolver = Owned<SNES, SNESDestroy>;

/// A vector of the same layout, zero.
Vector like(const Vector& vector);

} // namespace springproof::mechanics::petsc
