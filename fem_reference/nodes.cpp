#include "fem_reference/nodes.hpp"

#include "cases/case/index.hpp"
#include "fem_reference/space.hpp"

#include <deal.II/base/geometry_info.h>
#include <deal.II/dofs/dof_tools.h>

namespace springproof::fem_reference {

using cases::index;

/// deal.II numbers the three components of every support point one after another: a node is a block of three.
Nodes::Nodes(const Space& space, const cases::Scene& scene) {
  const dealii::IndexSet& owned = space.dofs.locally_owned_dofs();
  dealii::IndexSet ghosts = dealii::DoFTools::extract_locally_active_dofs(space.dofs);
  ghosts.subtract_set(owned);
  for (const auto& dofs : {owned, ghosts})
    for (const auto dof : dofs)
      if (dof % 3 == 0) global.push_back(static_cast<PetscInt>(dof / 3));
  n_owned = static_cast<int>(owned.n_elements() / 3);
  per_cell = static_cast<int>(space.node_element.n_dofs_per_cell());
  for (const auto& at : space.node_element.get_unit_support_points()) {
    between.emplace_back();
    for (unsigned v = 0; v < 8; ++v) // the weights are 1, 1/2, 1/4 or 1/8, or zero
      if (dealii::GeometryInfo<3>::d_linear_shape_function(at, v) > 0.1)
        between.back().push_back(static_cast<int>(v));
  }

  point.resize(global.size());
  mesh_node.assign(global.size(), -1);
  std::vector<dealii::types::global_dof_index> dofs(space.element.n_dofs_per_cell());
  for (const auto& cell : space.own_cells()) {
    cell->get_dof_indices(dofs);
    mesh_cell.push_back(cell->index());
    const auto& cell_vertices = scene.mesh.cells[index(mesh_cell.back())];
    for (unsigned a = 0; a < space.node_element.n_dofs_per_cell(); ++a) {
      const auto dof = dofs[space.element.component_to_system_index(0, a)];
      const auto node = owned.is_element(dof)
                            ? owned.index_within_set(dof) / 3
                            : static_cast<unsigned>(n_owned) + ghosts.index_within_set(dof) / 3;
      of_cell.push_back(static_cast<int>(node));
      point[node].setZero();
      for (const int v : between[a])
        point[node] +=
            scene.mesh.nodes[index(cell_vertices[index(v)])] / static_cast<double>(between[a].size());
      if (between[a].size() == 1) mesh_node[node] = cell_vertices[index(between[a][0])];
    }
  }
  n_cells = static_cast<int>(mesh_cell.size());
}

Vector Nodes::make_vector(MPI_Comm communicator) const {
  const auto n_ghosts = static_cast<PetscInt>(global.size()) - n_owned;
  Vector vector(get<Vec>(VecCreateGhostBlock, communicator, 3, 3 * n_owned, PETSC_DECIDE, n_ghosts,
                         global.data() + n_owned));
  check(VecSet(vector.get(), 0));
  return vector;
}

} // namespace springproof::fem_reference
