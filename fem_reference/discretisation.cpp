#include "fem_reference/discretisation.hpp"

#include "cases/case/index.hpp"
#include "fem_reference/loads.hpp"
#include "fem_reference/space.hpp"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/sparsity_tools.h>

namespace springproof::fem_reference {

Discretisation::Discretisation(const cases::Scene& scene, const ElementType& type,
                               const Prescribed& prescribed, MPI_Comm all_ranks)
    : space_(std::make_unique<Space>(scene, type, all_ranks)), communicator(space_->mesh.get_communicator()),
      element(type), nodes(*space_, scene), geometry(*space_, nodes, element),
      constraints(scene, nodes, prescribed, communicator),
      load(assemble_loads(scene, *space_, nodes, geometry, prescribed)) {
  if (!scene.material_of_cell.empty())
    for (const int cell : nodes.mesh_cell)
      material_of_cell.push_back(scene.material_of_cell[cases::index(cell)]);
}

Discretisation::~Discretisation() = default;

Matrix Discretisation::make_tangent_matrix() const {
  const dealii::IndexSet& owned = space_->dofs.locally_owned_dofs();
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(space_->dofs, relevant);
  dealii::AffineConstraints<double> lines(relevant);
  for (std::size_t i = 0; i < constraints.is_constrained.size(); ++i)
    if (constraints.is_constrained[i])
      lines.add_line(3 * static_cast<unsigned>(nodes.global[i / 3]) + static_cast<unsigned>(i % 3));
  lines.close();
  dealii::DynamicSparsityPattern pattern(relevant);
  dealii::DoFTools::make_sparsity_pattern(space_->dofs, pattern, lines, false);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned, communicator, relevant);
  dealii::PETScWrappers::MPI::SparseMatrix wrapper;
  wrapper.reinit(owned, owned, pattern, communicator);

  Mat matrix = wrapper;
  check(PetscObjectReference(reinterpret_cast<PetscObject>(matrix))); // outlives its wrapper
  Matrix result(matrix);
  check(MatSetBlockSize(matrix, 3)); // multigrid then coarsens nodes, not components
  const Vector layout = make_vector();
  const auto numbers = get<ISLocalToGlobalMapping>(VecGetLocalToGlobalMapping, layout.get());
  check(MatSetLocalToGlobalMapping(matrix, numbers, numbers));
  return result;
}

} // namespace springproof::fem_reference
