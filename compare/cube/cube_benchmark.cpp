#include "compare/cube/cube_benchmark.hpp"

#include "cases/case/read_case.hpp"
#include "compare/measure/measure.hpp"
#include "compare/provenance/machine.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

const MeasuredValue* find_measure(const Comparison& comparison, const std::string& name) {
  for (const MeasuredValue& measured : comparison.measures)
    if (measured.name == name) return &measured;
  return nullptr;
}

std::string why(const cases::Solution& failed) {
  if (!(failed.load_reached > 0)) return failed.message;
  return fmt::format("{} (reached: {:.2f} of the load)", failed.message, failed.load_reached);
}

bool is_sound(const cases::Solution& springs) {
  return springs.status == cases::Status::converged &&
         springs.outcome == cases::Outcome::stable_equilibrium && springs.inverted_cells == 0;
}

LoadSetErrors load_set_errors(const std::string& load_set, const std::vector<CubeSolve>& solves) {
  LoadSetErrors errors;
  ErrorSum lengths_and_angles, volumes;
  for (std::size_t t = 0; t < cube_tests.size(); ++t) {
    if (cube_tests[t].load_set != load_set) continue;
    const auto& [fem, msm] = solves.at(t);
    errors.is_stable = errors.is_stable && is_sound(msm.answers.msm.solution);
    const cases::Case& definition = fem.scene.definition;
    for (const cases::Measure& measure : definition.measures) {
      const MeasuredPair pair = measured_pair(fem, msm, measure.name);
      const std::optional<double> error = pair.error();
      errors.measures.push_back({definition.name, measure.name, error, error ? "" : pair.reason});
      if (!error && errors.failure.empty())
        errors.failure = fmt::format("{} {}: {}", load_set, cube_tests[t].test, pair.reason);
      if (!error) continue;
      if (measure.kind == cases::MeasureKind::volume)
        volumes.add(*error);
      else if (lengths_and_angles.add(*error))
        errors.worst_test = t;
    }
  }
  if (!errors.failure.empty()) return errors;
  errors.worst = lengths_and_angles.worst;
  errors.mean = lengths_and_angles.mean();
  errors.worst_volume = volumes.worst;
  return errors;
}

std::optional<double> larger(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::optional(std::max(*a, *b)) : std::nullopt;
}

} // namespace

MeasuredPair measured_pair(const Comparison& fem, const Comparison& msm, const std::string& measure) {
  const cases::Solution &on_fem = fem.answers.fem.solution, &on_msm = msm.answers.msm.solution;
  if (on_fem.status != cases::Status::converged) return {{}, {}, "finite elements: " + why(on_fem)};
  const MeasuredValue *of_fem = find_measure(fem, measure), *of_msm = find_measure(msm, measure);
  if (!of_fem) return {{}, {}, "the case has no measure " + measure};
  if (on_msm.status != cases::Status::converged) return {of_fem->fem, {}, "springs: " + why(on_msm)};
  return {of_fem->fem, of_msm ? of_msm->msm : std::nullopt, ""};
}

std::optional<double> MeasuredPair::error() const {
  return fem && msm ? error_percent(*fem, *msm) : std::nullopt;
}

cases::Case cube_case(const CubeTest& test, const cases::Material& material, double edge) {
  const bool is_ogden = std::holds_alternative<cases::Ogden>(material);
  cases::Case definition =
      cases::read_case(fmt::format("{}/thesis/{}/cube_{}_{}.toml", cases_folder(),
                                   is_ogden ? "ogden" : "linear_elastic", test.test, test.load_set));
  const double scale = msm::small_strain_material(material).youngs_modulus /
                       msm::small_strain_material(definition.material).youngs_modulus * edge * edge;
  definition.material = material;
  std::get<cases::Box>(definition.body).size *= edge; // from cells of 1 mm
  for (cases::Load& load : definition.loads) load.value *= scale;
  for (cases::Measure& measure : definition.measures)
    for (cases::Region* region : {&measure.node, &measure.top, &measure.bottom, &measure.centre})
      if (region->near) *region->near *= edge;
  return definition;
}

std::optional<double> CubeErrors::worst() const {
  return larger(small.worst, large.worst);
}
std::optional<double> CubeErrors::worst_volume() const {
  return larger(small.worst_volume, large.worst_volume);
}

CubeErrors cube_errors(const std::vector<CubeSolve>& solves) {
  return {load_set_errors("small", solves), load_set_errors("large", solves)};
}

} // namespace springproof::compare
