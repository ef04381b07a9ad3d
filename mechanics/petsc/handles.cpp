#include "mechanics/petsc/handles.hpp"

#include <stdexcept>
#include <string>

namespace springproof::mechanics::petsc {

void check(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw std::runtime_error(std::string("PETSc: ") + (text != nullptr ? text : "unknown error"));
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
