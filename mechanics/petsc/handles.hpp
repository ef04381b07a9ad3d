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

/// Access to the entries of a vector that this rank has: its own, then the ghosts.
template<class Entry, PetscErrorCode (*get)(Vec, Entry**), PetscErrorCode (*restore)(Vec, Entry**)>
class Entries {
 public:
  explicit Entries(Vec vector) : vector_(vector) {
    check(VecGhostGetLocalForm(vector, &local_));
    check(get(local_ != nullptr ? local_ : vector, &entries_));
  }
  ~Entries() {
    restore(local_ != nullptr ? local_ : vector_, &entries_);
    VecGhostRestoreLocalForm(vector_, &local_);
  }
  Entries(const Entries&) = delete;
  Entries& operator=(const Entries&) = delete;
  Entry* data() const { return entries_; }
  template<class Index>
  Entry& operator[](Index i) const {
    return entries_[i];
  }

 private:
  Vec vector_, local_ = nullptr;
  Entry* entries_ = nullptr;
};
using ReadEntries = Entries<const PetscScalar, VecGetArrayRead, VecRestoreArrayRead>;
using WriteEntries = Entries<PetscScalar, VecGetArray, VecRestoreArray>;

/// Ghosts from the ranks that own them.
void update_ghosts(Vec vector);
/// Adds what ranks have in ghosts to the owners' entries.
void add_ghosts(Vec vector);

} // namespace springproof::mechanics::petsc
