#include "mechanics/petsc/rigid_motions.hpp"

namespace springproof::mechanics::petsc {

void attach_rigid_motions(Mat matrix, const std::vector<Eigen::Vector3d>& points) {
  Vec coordinates = nullptr;
  PetscInt n = 0;
  check(MatCreateVecs(matrix, &coordinates, nullptr));
  const Vector owned(coordinates);
  check(VecSetBlockSize(coordinates, 3));
  check(VecGetLocalSize(coordinates, &n));
  {
    const WriteEntries entries(coordinates);
    for (PetscInt i = 0; i < n; ++i) entries[i] = points[static_cast<std::size_t>(i / 3)][i % 3];
  }
  MatNullSpace rigid = nullptr;
  check(MatNullSpaceCreateRigidBody(coordinates, &rigid));
  const NullSpace owned_space(rigid);
  check(MatSetNearNullSpace(matrix, rigid));
}

} // namespace springproof::mechanics::petsc
