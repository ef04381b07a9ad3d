#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/element.hpp"

#include <deal.II/base/quadrature.h>
#include <deal.II/distributed/tria_base.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/grid/filtered_iterator.h>
#include <memory>

namespace springproof::fem_reference {

/// deal.II's mesh of a scene and its degrees of freedom. The headers are slow to compile: for the few sources
/// that hand deal.II's work over as plain arrays.
struct Space {
  /// The scene's cells become coarse cells and are never refined: vertex numbers stay the scene's node
  /// numbers.
  Space(const cases::Scene& scene, const ElementType& type, MPI_Comm communicator);

  auto own_cells() const {
    return dofs.active_cell_iterators() | dealii::IteratorFilters::LocallyOwnedCell();
  }

  cases::CellShape shape;
  std::unique_ptr<dealii::parallel::TriangulationBase<3>> mesh;
  std::unique_ptr<dealii::Mapping<3>> mapping;
  std::unique_ptr<dealii::FiniteElement<3>> node_element;
  dealii::FESystem<3> element;
  dealii::DoFHandler<3> dofs;

  /// Points of ElementType::n_points(), for the stress.
  dealii::Quadrature<3> quadrature;
  /// Points of a face, for tractions that vary.
  dealii::Quadrature<2> quadrature_of_faces;
};

} // namespace springproof::fem_reference
