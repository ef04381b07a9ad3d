#include "compare/cube/cube_study.hpp"

#include "cases/case/read_case.hpp"
#include "compare/measure/measure.hpp"
#include "compare/provenance/cases_folder.hpp"
#include "msm/model.hpp"
#include "msm/tangent.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace springproof::compare {

namespace {

cases::Case definition_of(const cases::Material& material, const std::string& test, const std::string& set) {
  const bool is_ogden = std::holds_alternative<cases::Ogden>(material);
  const std::string folder = cases_folder() + "/thesis/" + (is_ogden ? "ogden" : "linear_elastic");
  cases::Case definition = cases::read_case(folder + "/cube_" + test + "_" + set + ".toml");
  definition.material = material;
  definition.fem.formulation = is_ogden         ? cases::Formulation::hyperelastic
                               : set == "small" ? cases::Formulation::small_strain
                                                : cases::Formulation::log_strain;
  definition.fem.element = is_ogden ? cases::Element::q1_p0 : cases::Element::q1_bbar;
  return definition;
}

bool has_definite_tangent(const cases::Scene& scene, const msm::CellStiffness& stiffness,
                          const cases::Solution& solution) {
  const msm::Lattice lattice = msm::make_lattice(scene.mesh, {stiffness});
  msm::Points positions = lattice.rest;
  for (std::size_t n = 0; n < positions.size(); ++n) positions[n] += solution.displacement[n];
  msm::Tangent tangent(lattice, cases::fixed_degrees_of_freedom(scene));
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factorisation(
      tangent.assemble(positions, msm::TransverseTerm::exact));
  return factorisation.info() == Eigen::Success;
}

void add_test(CubeErrors& errors, const Comparison& fem, const msm::CellStiffness& stiffness) {
  const cases::Scene& scene = fem.scene;
  cases::Solution solution;
  std::string message = fem.answers.fem.solution.message;
  try {
    solution = msm::Model(scene, {stiffness}).solve();
  } catch (const cases::SolveError& error) {
    message = error.what() + std::string(" (load reached: ") + std::to_string(error.load_reached()) + ")";
  }
  const bool solved = solution.status == cases::Status::converged &&
                      fem.answers.fem.solution.status == cases::Status::converged;
  errors.is_stable = errors.is_stable && solved && solution.inverted_cells == 0 &&
                     has_definite_tangent(scene, stiffness, solution);
  for (const cases::Measure& measure : scene.definition.measures) {
    CubeError entry{scene.definition.name, measure.name, std::nullopt, message};
    if (solved)
      entry.error_percent = error_percent(evaluate(measure, scene, fem.answers.fem.solution),
                                          evaluate(measure, scene, solution));
    errors.measures.push_back(entry);
  }
}

std::optional<double> worst_of(const std::vector<CubeError>& measures, bool volume) {
  double worst = 0;
  for (const CubeError& m : measures) {
    if ((m.measure == "volume") != volume) continue;
    if (!m.error_percent) return std::nullopt;
    worst = std::max(worst, std::abs(*m.error_percent));
  }
  return worst;
}

} // namespace

CubeReference solve_cube_reference(const cases::Material& material, LoadSets sets) {
  CubeReference reference;
  for (const char* set : {"small", "large"}) {
    if (set == std::string("large") && sets == LoadSets::small) continue;
    for (const char* test : {"tensile", "shear", "torsion"})
      reference.tests.push_back(compare_case(definition_of(material, test, set), {cases::Side::fem}));
  }
  return reference;
}

std::optional<double> CubeErrors::worst() const {
  return worst_of(measures, false);
}
std::optional<double> CubeErrors::worst_volume() const {
  return worst_of(measures, true);
}

CubeErrors cube_errors(const CubeReference& reference, const msm::CellStiffness& stiffness) {
  CubeErrors errors;
  for (const Comparison& test : reference.tests) add_test(errors, test, stiffness);
  return errors;
}

} // namespace springproof::compare
