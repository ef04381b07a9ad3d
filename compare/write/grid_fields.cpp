#include "compare/write/grid_fields.hpp"

#include "cases/mesh/sharing.hpp"
#include "cases/scene/in_time.hpp"
#include "cases/scene/masses.hpp"
#include "compare/measure/measure.hpp"
#include "compare/measure/tensor.hpp"

#include <algorithm>

namespace springproof::compare {

namespace {

using Eigen::Vector3d;

std::vector<double> von_mises_of(const std::vector<cases::SymmetricTensor>& stress) {
  std::vector<double> values(stress.size());
  std::transform(stress.begin(), stress.end(), values.begin(), von_mises);
  return values;
}

/// @param cells  that the fields are of
void add_fields(cases::GridFields& all, const std::string& side, const cases::HexMesh& mesh,
                const cases::Range& cells, const cases::Fields& fields) {
  all.point_vectors.push_back({side + "_reaction", fields.reaction, "N"});
  all.cell_tensors.push_back({side + "_strain", fields.strain, "1"});
  if (!fields.has_stress) return;
  all.cell_tensors.push_back({side + "_stress", fields.stress, "MPa"});
  all.cell_numbers.push_back({side + "_von_mises", von_mises_of(fields.stress), "MPa"});
  std::vector<double> density = fields.strain_energy;
  for (std::size_t c = 0; c < density.size(); ++c)
    density[c] /= cases::cell_volume(cases::cell_vertices(mesh, cells.begin + c));
  all.cell_numbers.push_back({side + "_strain_energy_density", density, "N mm/mm3"});
}

void add_side(cases::GridFields& all, const std::string& side, const cases::HexMesh& mesh,
              const cases::Solution& solution) {
  if (solution.status != cases::Status::converged) return;
  const cases::Sharing* const sharing = solution.sharing.get();
  all.point_vectors.push_back({side + "_displacement", solution.displacement, "mm"});
  all.cell_numbers.push_back({side + "_cell_volume", solution.cell_volume, "mm3"});
  const std::vector<bool> inverted = cases::inverted_cells(mesh, solution.displacement, sharing);
  all.cell_numbers.push_back({side + "_inverted", {inverted.begin(), inverted.end()}, "1"});
  if (solution.fields) add_fields(all, side, mesh, cases::share_here(mesh, sharing).cells, *solution.fields);
}

/// What the springs are off the finite elements on the same mesh.
void add_errors(cases::GridFields& all, const cases::HexMesh& mesh, const cases::Solution& fem,
                const cases::Solution& msm) {
  if (fem.status != cases::Status::converged || msm.status != cases::Status::converged) return;
  std::vector<Vector3d> difference = msm.displacement;
  std::vector<double> error;
  for (std::size_t n = 0; n < difference.size(); ++n) {
    difference[n] -= fem.displacement[n];
    error.push_back(difference[n].norm());
  }
  all.point_vectors.push_back({"difference", difference, "mm"});
  all.point_numbers.push_back({"error", error, "mm"});
  const double largest =
      field_norm(cases::measures::DisplacementFieldMax{}, mesh, fem.displacement, fem.sharing.get());
  if (largest > 0) {
    for (double& value : error) value /= largest;
    all.point_numbers.push_back({"relative_error", error, "1"});
  }
  const auto has_stress = [](const cases::Solution& side) { return side.fields && side.fields->has_stress; };
  if (!has_stress(fem) || !has_stress(msm)) return;
  std::vector<double> stress = von_mises_of(msm.fields->stress);
  const std::vector<double> reference = von_mises_of(fem.fields->stress);
  for (std::size_t c = 0; c < stress.size(); ++c) stress[c] -= reference[c];
  all.cell_numbers.push_back({"von_mises_difference", stress, "MPa"});
}

void add_case(cases::GridFields& all, const cases::Scene& scene, const cases::Share& here) {
  if (!scene.loads.empty() && !cases::has_load_histories(scene)) {
    std::vector<Vector3d> force(here.nodes.size(), Vector3d::Zero());
    for (const auto& [node, value] : cases::applied_forces(scene))
      if (here.nodes.has(cases::index(node))) force[cases::index(node) - here.nodes.begin] += value;
    all.point_vectors.push_back({"applied_force", force, "N"});
  }
  std::vector<double> material;
  for (std::size_t c = here.cells.begin; c < here.cells.end; ++c)
    material.push_back(cases::material_of(scene, c));
  all.cell_numbers.push_back({"material", material});
}

} // namespace

cases::GridFields grid_fields_of(const Comparison& comparison) {
  const cases::Scene& scene = comparison.scene;
  const cases::Solution &fem = comparison.answers.fem.solution, &msm = comparison.answers.msm.solution;
  cases::GridFields all;
  add_side(all, "fem", scene.mesh, fem);
  add_side(all, "msm", scene.mesh, msm);
  add_errors(all, scene.mesh, fem, msm);
  add_case(all, scene, cases::share_here(scene.mesh, sharing_of(comparison)));
  return all;
}

const cases::Sharing* sharing_of(const Comparison& comparison) {
  const Answers& answers = comparison.answers;
  const cases::Sharing* const of_fem = answers.fem.solution.sharing.get();
  return of_fem ? of_fem : answers.msm.solution.sharing.get();
}

} // namespace springproof::compare
