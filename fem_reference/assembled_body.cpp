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

std::optional<cases::FieldNorms> norms_of(AssembledBody& body, const State& state,
                                          const cases::Sharing* sharing) {
  const int degree = body.discretisation.element.degree;
  if (!has_own_norms(body.scene.definition, degree)) return std::nullopt;
  DisplacementNorms norms(degree, body.discretisation.nodes.in_unit_cube());
  body.equations.add_norms(state, norms);
  return norms.norms(sharing);
}

std::optional<cases::FieldNorms> norms_of(const grid::GridBody& body, const State& state,
                                          const cases::Sharing* sharing) {
  const cases::Scene& scene = body.scene;
  const ElementType type = element_type(scene.definition.fem, formulations_of(scene).front());
  if (!has_own_norms(scene.definition, type.degree)) return std::nullopt;
  const Cuboid cuboid(type, scene.mesh.grid->spacing / body.cell_factor);
  DisplacementNorms norms(type.degree, cuboid.nodes());
  body.for_each_element(state, sharing, [&](const grid::GridBody::Element& element) {
    norms.add(cuboid.geometry(), element.displacement.data());
  });
  return norms.norms(sharing);
}

cases::Fields fields_of(AssembledBody& body, const State& state, const cases::Sharing* sharing,
                        double load_factor) {
  cases::Range cells;
  const int refine = body.scene.definition.fem.refine;
  for (const int number : body.discretisation.nodes.mesh_cell) {
    const std::size_t cell = index(number >> 3 * refine);
    if (cells.size() == 0) cells = {cell, cell + 1};
    cells = {std::min(cells.begin, cell), std::max(cells.end, cell + 1)};
  }
  ElementFields sums(body.scene, body.formulations.front().kinematics,
                     body.discretisation.nodes.in_unit_cube(), cells);
  body.equations.add_fields(state, refine, sums);
  return sums.fields(sharing, load_factor);
}

/// Evaluates the fields with the assembled backend's kernels, one element at a time.
cases::Fields fields_of(const grid::GridBody& body, const State& state, const cases::Sharing* sharing,
                        double load_factor) {
  const cases::Scene& scene = body.scene;
  const std::vector<Formulation> formulations = formulations_of(scene);
  const ElementType type = element_type(scene.definition.fem, formulations.front());
  const Cuboid cuboid(type, scene.mesh.grid->spacing / body.cell_factor);
  const CellGeometry geometry = cuboid.geometry();
  std::vector<std::unique_ptr<CellKernel>> kernels;
  for (const Formulation& formulation : formulations) kernels.push_back(formulation.make_kernel(type));
  ElementFields sums(scene, formulations.front().kinematics, cuboid.nodes(), body.cells(sharing));
  body.for_each_element(state, sharing, [&](const grid::GridBody::Element& element) {
    CellKernel& kernel = *kernels[index(cases::material_of(scene, element.cell))];
    const double* displacement = element.displacement.data();
    const CellResult& result = kernel.evaluate(geometry, displacement, &element.pressure, Wanted::stress);
    const double edge = 1. / element.n_parts;
    const Eigen::Vector3d lower = edge * Eigen::Vector3d(element.part[0], element.part[1], element.part[2]);
    sums.add({{element.cell, lower, edge},
              geometry,
              displacement,
              result.plain_force.data(),
              kernel.energy(geometry, displacement, &element.pressure)});
  });
  return sums.fields(sharing, load_factor);
}

} // namespace springproof::fem_reference
