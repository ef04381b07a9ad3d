#include "mechanics/petsc/handles.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

namespace springproof::mechanics::petsc {

namespace {

std::string& last_error() {
  static std::string text;
  return text;
}

/// The first of the handlers of an error knows what happened, those of the callers only where.
PetscErrorCode keep_text(MPI_Comm, int, const char*, const char*, PetscErrorCode code, PetscErrorType type,
                         const char* text, void*) {
  if (type == PETSC_ERROR_INITIAL) last_error() = text != nullptr ? text : "";
  return code;
}

} // namespace

void check(PetscErrorCode code) {
  if (code == 0) return;
  if (code == PETSC_ERR_MEM) throw std::bad_alloc();
  const char* kind = nullptr;
  PetscErrorMessage(code, &kind, nullptr);
  std::string message = std::string("PETSc: ") + (kind != nullptr ? kind : "unknown error");
  if (const std::string text = std::exchange(last_error(), ""); !text.empty()) message += ": " + text;
  std::replace(message.begin(), message.end(), '\n', ' ');
  throw std::runtime_error(message);
}

void keep_quiet() {
  check(PetscPushErrorHandler(keep_text, nullptr));
}

void check_memory_of(KSP solver) {
  const PC preconditioner = get<PC>(KSPGetPC, solver);
  if (get<PCFailedReason>(PCGetFailedReason, preconditioner) != PC_FACTOR_OUTMEMORY) return;
  const Mat factor = get<Mat>(PCFactorGetMatrix, preconditioner);
  constexpr PetscInt allocation_failed = -13; // INFOG(1); others mean estimates that were too low
  if (get<PetscInt>(MatMumpsGetInfog, factor, 1) == allocation_failed) throw std::bad_alloc();
}

Vector like(const Vector& vector) {
  Vector copy(get<Vec>(VecDuplicate, vector.get()));
  check(VecSet(copy.get(), 0));
  return copy;
}

void update_ghosts(Vec vector) {
  check(VecGhostUpdateBegin(vector, INSERT_VALUES, SCATTER_FORWARD));
  check(VecGhostUpdateEnd(vector, INSERT_VALUES, SCATTER_FORWARD));
}

void add_ghosts(Vec vector) {
  check(VecGhostUpdateBegin(vector, ADD_VALUES, SCATTER_REVERSE));
  check(VecGhostUpdateEnd(vector, ADD_VALUES, SCATTER_REVERSE));
}

void attach_rigid_motions(Mat matrix, const std::vector<Eigen::Vector3d>& points) {
  Vec coordinates = nullptr;
  check(MatCreateVecs(matrix, &coordinates, nullptr));
  const Vector owned(coordinates);
  check(VecSetBlockSize(coordinates, 3));
  const auto n = get<PetscInt>(VecGetLocalSize, coordinates);
  {
    const WriteEntries entries(coordinates);
    for (PetscInt i = 0; i < n; ++i) entries[i] = points[static_cast<std::size_t>(i / 3)][i % 3];
  }
  const NullSpace rigid(get<MatNullSpace>(MatNullSpaceCreateRigidBody, coordinates));
  check(MatSetNearNullSpace(matrix, rigid.get()));
}

} // namespace springproof::mechanics::petsc
