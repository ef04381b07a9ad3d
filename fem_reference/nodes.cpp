#include "fem_reference/nodes.hpp"

#include "cases/case/index.hpp"
#include "fem_reference/space.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace springproof::fem_reference {

using cases::index;

/// deal.II numbers the three components of every support point one after another: a node is a block of three.
Nodes::Nodes(const Space& space, const cases::Scene& scene) {
  const auto& owned = space.dofs.locally_owned_dofs();
  n_owned = static_cast<int>(owned.n_elements() / 3);
  const int first_owned = n_owned > 0 ? static_cast<int>(owned.nth_index_in_set(0) / 3) : 0;
  per_cell = static_cast<int>(space.node_element.n_dofs_per_cell());
  for (const auto& at : space.node_element.get_unit_support_points()) {
    between.emplace_back();
    for (int v = 0; v < 8; ++v) // at a coordinate of 1/2 a vertex is as near as the opposite one
      if (std::abs(at[0] - (v & 1)) < 0.75 && std::abs(at[1] - (v >> 1 & 1)) < 0.75 &&
          std::abs(at[2] - (v >> 2)) < 0.75)
        between.back().push_back(v);
  }

  std::vector<dealii::types::global_dof_index> dofs(space.element.n_dofs_per_cell());
  std::vector<PetscInt> cell_global;
  for (const auto& cell : space.own_cells()) {
    cell->get_dof_indices(dofs);
    mesh_cell.push_back(cell->index());
    for (unsigned a = 0; a < space.node_element.n_dofs_per_cell(); ++a)
      cell_global.push_back(static_cast<PetscInt>(dofs[space.element.component_to_system_index(0, a)] / 3));
  }
  n_cells = static_cast<int>(mesh_cell.size());
  const auto is_owned = [&](PetscInt node) { return node >= first_owned && node < first_owned + n_owned; };
  std::set<PetscInt> ghosts;
  std::remove_copy_if(cell_global.begin(), cell_global.end(), std::inserter(ghosts, ghosts.end()), is_owned);
  global.resize(index(n_owned));
  std::iota(global.begin(), global.end(), first_owned);
  global.insert(global.end(), ghosts.begin(), ghosts.end());

  point.resize(global.size());
  mesh_node.assign(global.size(), -1);
  for (std::size_t i = 0; i < cell_global.size(); ++i) {
    const auto ghost = std::lower_bound(global.begin() + n_owned, global.end(), cell_global[i]);
    const auto node = is_owned(cell_global[i]) ? cell_global[i] - first_owned : ghost - global.begin();
    of_cell.push_back(static_cast<int>(node));
    const auto& vertices = between[i % index(per_cell)];
    const auto& cell = scene.mesh.cells[index(mesh_cell[i / index(per_cell)])];
    point[index(node)].setZero();
    for (const int v : vertices)
      point[index(node)] += scene.mesh.nodes[index(cell[index(v)])] / static_cast<double>(vertices.size());
    if (vertices.size() == 1) mesh_node[index(node)] = cell[index(vertices[0])];
  }
}

Vector Nodes::make_vector(MPI_Comm communicator) const {
  Vec vector = nullptr;
  check(VecCreateGhostBlock(communicator, 3, 3 * n_owned, PETSC_DECIDE,
                            static_cast<PetscInt>(global.size()) - n_owned, global.data() + n_owned,
                            &vector));
  Vector owned_vector(vector);
  check(VecSet(vector, 0));
  return owned_vector;
}

} // namespace springproof::fem_reference
