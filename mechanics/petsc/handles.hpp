#pragma once

#include <Eigen/Core>
#include <exception>
#include <memory>
#include <petscsf.h>
#include <petscsnes.h>
#include <type_traits>
#include <utility>
#include <vector>

/// Owning handles for PETSc's objects; its error codes as exceptions, and exceptions as its error codes.
namespace springproof::mechanics::petsc {

/// @throws std::bad_alloc for want of memory; std::runtime_error with PETSc's message for another non-zero
/// code: a programming error, never a solver that failed to converge
void check(PetscErrorCode code);

/// Keeps PETSc from printing its errors from now on: check() reports them.
void keep_quiet();

/// @throws std::bad_alloc if MUMPS had too little memory for the factorisation in a solver's preconditioner
void check_memory_of(KSP solver);

/// What a function of PETSc sets through its last argument: get<PC>(KSPGetPC, solver).  @throws as check()
template<class Value, class Function, class... Arguments>
Value get(const Function& function, const Arguments&... arguments) {
  Value value{};
  check(function(arguments..., &value));
  return value;
}

template<class Object, PetscErrorCode (*destroy)(Object*)>
struct Destroy {
  void operator()(Object object) const { destroy(&object); }
};
template<class Object, PetscErrorCode (*destroy)(Object*)>
using Owned = std::unique_ptr<std::remove_pointer_t<Object>, Destroy<Object, destroy>>;

using Vector = Owned<Vec, VecDestroy>;
using Matrix = Owned<Mat, MatDestroy>;
using StarForest = Owned<PetscSF, PetscSFDestroy>; ///< who sends which entries to whom
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

/// Updates ghosts from the ranks that own them.
void update_ghosts(Vec vector);
/// Adds what ranks have in ghosts to the owners' entries.
void add_ghosts(Vec vector);

/// Gives a matrix of 3x3 blocks the rigid motions of its points as near null space: what algebraic multigrid
/// must represent on its coarse levels.
/// @param points  rest positions (mm), those of this rank's rows first; any behind them are not looked at
void attach_rigid_motions(Mat matrix, const std::vector<Eigen::Vector3d>& points);

/// Exceptions of functions that PETSc calls: they must not pass through its C code.
class CallbackErrors {
 public:
  /// Returns an error code for a callback to return in place of an exception, which is kept.
  template<class Action>
  PetscErrorCode run(const Action& action) noexcept {
    try {
      action();
      return 0;
    } catch (...) {
      error_ = std::current_exception();
      return PETSC_ERR_LIB;
    }
  }

  /// Calls a function of PETSc that calls back.  @throws what a callback threw, else as check()
  template<class Action>
  void call(const Action& action) {
    const PetscErrorCode code = action();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    check(code);
  }

 private:
  std::exception_ptr error_;
};

} // namespace springproof::mechanics::petsc
