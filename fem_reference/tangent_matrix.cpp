#include "fem_reference/tangent_matrix.hpp"

#include "fem_reference/space.hpp"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/sparsity_tools.h>

namespace springproof::fem_reference {

Matrix make_tangent_matrix(const Space& space, const Nodes& nodes, const Constraints& constraints) {
  const MPI_Comm communicator = space.mesh.get_communicator();
  const dealii::IndexSet& owned = space.dofs.locally_owned_dofs();
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(space.dofs, relevant);
  dealii::AffineConstraints<double> lines(relevant);
  for (std::size_t i = 0; i < constraints.is_constrained.size(); ++i)
    if (constraints.is_constrained[i])
      lines.add_line(3 * static_cast<unsigned>(nodes.global[i / 3]) + static_cast<unsigned>(i % 3));
  lines.close();
  dealii::DynamicSparsityPattern pattern(relevant);
  dealii::DoFTools::make_sparsity_pattern(space.dofs, pattern, lines, false);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned, communicator, relevant);
  dealii::PETScWrappers::MPI::SparseMatrix wrapper;
  wrapper.reinit(owned, owned, pattern, communicator);

  Mat matrix = wrapper;
  check(PetscObjectReference(reinterpret_cast<PetscObject>(matrix))); // outlives its wrapper
  Matrix result(matrix);
  check(MatSetBlockSize(matrix, 3)); // multigrid then coarsens nodes, not components
  ISLocalToGlobalMapping mapping = nullptr;
  check(ISLocalToGlobalMappingCreate(communicator, 3, static_cast<PetscInt>(nodes.global.size()),
                                     nodes.global.data(), PETSC_COPY_VALUES, &mapping));
  check(MatSetLocalToGlobalMapping(matrix, mapping, mapping));
  check(ISLocalToGlobalMappingDestroy(&mapping));
  return result;
}

} // namespace springproof::fem_reference
