#include "fem_reference/space.hpp"

namespace springproof::fem_reference {

/// The scene's cells become coarse cells and are never refined: vertex numbers stay the scene's node numbers.
Space::Space(const cases::Scene& scene, const ElementType& type, MPI_Comm communicator)
    : mesh(communicator), node_element(static_cast<unsigned>(type.degree)), element(node_element, 3),
      dofs(mesh) {
  std::vector<dealii::Point<3>> vertices;
  for (const Eigen::Vector3d& node : scene.mesh.nodes) vertices.emplace_back(node.x(), node.y(), node.z());
  std::vector<dealii::CellData<3>> cells(scene.mesh.cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
    cells[c].vertices.assign(scene.mesh.cells[c].begin(), scene.mesh.cells[c].end());
  mesh.create_triangulation(vertices, cells, dealii::SubCellData());
  dofs.distribute_dofs(element);
}

} // namespace springproof::fem_reference
