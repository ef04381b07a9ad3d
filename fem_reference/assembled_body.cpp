#include "fem_reference/assembled_body.hpp"

#include "fem_reference/cuboid.hpp"
#include "mechanics/ranks/share_out.hpp"

#include <algorithm>

namespace springproof::fem_reference {

using cases::index;

std::vector<Formulation> formulations_of(const cases::Scene& scene) {
  std::vector<Formulation> formulations;
  for (const cases::Material& material : cases::materials_of(scene.definition))
    formulations.push_back(make_formulation(scene.definition.fem, material));
  return formulations;
}

AssembledBody::AssembledBody(const cases::Scene& the_scene, MPI_Comm communicator)
    : scene(the_scene), formulations(formulations_of(scene)),
      discretisation(cases::refine(scene, scene.definition.fem.refine),
                     element_type(scene.definition.fem, formulations.front()), {}, communicator),
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
    const std::vector<double> own = equations.cell_volumes(state);
    const int shift = 3 * scene.definition.fem.refine;
    for (std::size_t cell = 0; cell < own.size(); ++cell)
      volumes.push_back({discretisation.nodes.mesh_cell[cell] >> shift, own[cell]});
    return volumes;
  };
  return {scene.mesh,
          mechanics::share_out(scene.mesh, discretisation.communicator),
          {displacements, cell_volumes}};
}

std::optional<cases::FieldNorms> AssembledBody::norms(const State& state, const cases::Sharing* sharing) {
  const int degree = discretisation.element.degree;
  if (!has_own_norms(scene.definition, degree)) return std::nullopt;
  DisplacementNorms norms(degree, discretisation.nodes.in_unit_cube());
  equations.add_norms(state, norms);
  return norms.norms(sharing);
}

cases::Fields AssembledBody::fields(const State& state, const cases::Sharing* sharing, double load_factor) {
  cases::Range cells;
  const int shift = 3 * scene.definition.fem.refine;
  for (const int number : discretisation.nodes.mesh_cell) {
    const std::size_t cell = index(number >> shift);
    if (cells.size() == 0) cells = {cell, cell + 1};
    cells = {std::min(cells.begin, cell), std::max(cells.end, cell + 1)};
  }
  ElementFields sums(scene, formulations.front().kinematics, discretisation.nodes.in_unit_cube(), cells);
  equations.add_fields(state, scene.definition.fem.refine, sums);
  return sums.fields(sharing, load_factor);
}

std::optional<cases::FieldNorms> norms_of(const grid::GridModel& model, const cases::Sharing* sharing) {
  const cases::Scene& scene = model.scene();
  const ElementType type = element_type(scene.definition.fem, formulations_of(scene).front());
  if (!has_own_norms(scene.definition, type.degree)) return std::nullopt;
  const Cuboid cuboid(type, scene.mesh.grid->spacing / (1 << scene.definition.fem.refine));
  DisplacementNorms norms(type.degree, cuboid.nodes());
  model.for_each_element(sharing, [&](const grid::GridModel::Element& element) {
    norms.add(cuboid.geometry(), element.displacement.data());
  });
  return norms.norms(sharing);
}

} // namespace springproof::fem_reference
