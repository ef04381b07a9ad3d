#include "fem_reference/assembled_body.hpp"

#include "mechanics/ranks/share_out.hpp"

#include <algorithm>

namespace springproof::fem_reference {

using cases::index;

AssembledBody::AssembledBody(const cases::Scene& the_scene, MPI_Comm communicator)
    : scene(the_scene), formulations(formulations_of(scene)),
      discretisation(cases::refine(scene, scene.definition.fem.refine),
                     element_type(scene.definition.fem, formulations.front()), communicator),
      equations(discretisation, formulations) {}

mechanics::StateOnMesh AssembledBody::on_mesh() {
  // Nodes of the body's mesh are the first of the refined mesh.
  const auto displacements = [this](const State& state) {
    std::vector<cases::Numbered<Eigen::Vector3d>> own;
    for (int node = 0; node < discretisation.nodes.n_owned; ++node) {
      const int number = discretisation.nodes.mesh_node[index(node)];
      if (number >= 0 && index(number) < scene.mesh.nodes.size())
        own.push_back({number, state.segment<3>(3 * node)});
    }
    return own;
  };
  // Each cell of the body is its 8^refine descendants.
  const auto cell_volumes = [this](const State& state) {
    std::vector<cases::Numbered<double>> volumes;
    const int shift = 3 * scene.definition.fem.refine;
    equations.for_each_cell(
        state, [&](int cell, const CellGeometry& geometry, const double* displacement, const double*) {
          volumes.push_back({discretisation.nodes.mesh_cell[index(cell)] >> shift,
                             CellKernel::deformed_volume(geometry, displacement)});
        });
    return volumes;
  };
  return {scene.mesh,
          mechanics::share_out(scene.mesh, discretisation.communicator),
          {displacements, cell_volumes}};
}

/// Lists the rest position and displacement (mm) of this rank's nodes, 6 numbers each.
std::vector<double> AssembledBody::node_displacements(const State& state) const {
  std::vector<double> numbers;
  for (int node = 0; node < discretisation.nodes.n_owned; ++node) {
    const Eigen::Vector3d &rest = discretisation.nodes.point[index(node)], moved = state.segment<3>(3 * node);
    numbers.insert(numbers.end(), rest.begin(), rest.end());
    numbers.insert(numbers.end(), moved.begin(), moved.end());
  }
  return numbers;
}

void AssembledBody::set_in_motion(const mechanics::EquilibriumSettings&) {
  equations.set_in_motion(cases::refine(scene, scene.definition.fem.refine), formulations);
}

ElementsInState elements_of(const cases::Scene& scene, const std::vector<Formulation>& formulations,
                            const Discretisation& discretisation, EquilibriumEquations& equations,
                            const State& state) {
  const std::vector<int>& refined_cells = discretisation.nodes.mesh_cell;
  const int refine = scene.definition.fem.refine;
  cases::Range cells;
  for (const int number : refined_cells) {
    const std::size_t cell = index(number >> 3 * refine);
    if (cells.size() == 0) cells = {cell, cell + 1};
    cells = {std::min(cells.begin, cell), std::max(cells.end, cell + 1)};
  }
  const auto for_each = [&equations, &refined_cells, &state, refine,
                         shape = scene.mesh.shape](const auto& action) {
    equations.for_each_cell(state, [&](int cell, const CellGeometry& geometry, const double* displacement,
                                       const double* internal) {
      action({place_of(shape, index(refined_cells[index(cell)]), refine), geometry, displacement, internal});
    });
  };
  const auto products = [&geometry = discretisation.geometry](const CellGeometry& cell) {
    return geometry.products(cell);
  };
  return {scene, formulations, discretisation.element, discretisation.nodes.in_reference_cell, products,
          cells, for_each};
}

} // namespace springproof::fem_reference
