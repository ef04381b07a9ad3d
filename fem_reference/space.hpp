#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/element.hpp"

#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/filtered_iterator.h>

namespace springproof::fem_reference {

/// deal.II's mesh of a scene and its degrees of freedom. The headers are slow to compile: for the few sources
/// that hand deal.II's work over as plain arrays.
struct Space {
  /// The scene's cells become coarse cells and are never refined: vertex numbers stay the scene's node
  /// numbers.
  Space(const cases::Scene& scene, const ElementType& type, MPI_Comm communicator)
      : mesh(communicator), node_element(static_cast<unsigned>(type.degree)), element(node_element, 3),
        dofs(mesh) {
    std::vector<dealii::Point<3>> vertices;
    for (const Eigen::Vector3d& node : scene.mesh.nodes) vertices.emplace_back(node.x(), node.y(), node.z());
    std::vector<dealii::CellData<3>> cells(scene.mesh.cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const cases::CellNodes nodes = scene.mesh.cells[c];
      cells[c].vertices.assign(nodes.begin(), nodes.end());
    }
    mesh.create_triangulation(vertices, cells, dealii::SubCellData());
    dofs.distribute_dofs(element);
  }

  auto own_cells() const {
    return dofs.active_cell_iterators() | dealii::IteratorFilters::LocallyOwnedCell();
  }

  dealii::MappingQ1<3> mapping;
  dealii::parallel::distributed::Triangulation<3> mesh;
  dealii::FE_Q<3> node_element;
  dealii::FESystem<3> element;
  dealii::DoFHandler<3> dofs;
};

} // namespace springproof::fem_reference
