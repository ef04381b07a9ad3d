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
  Space(const cases::Scene& scene, const ElementType& type, MPI_Comm communicator);

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
