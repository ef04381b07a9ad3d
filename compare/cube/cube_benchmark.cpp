#include "compare/cube/cube_benchmark.hpp"

#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/measure/measure.hpp"
#include "compare/provenance/machine.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <list>

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

DesignAttempt designed(const std::string& name, const msm::DesignRequest& request) {
  DesignAttempt result{name, msm::design(request)};
  result.options = request.options;
  const double edge = msm::cube_edge(request.cell);
  if (edge > 0 && result.design->is_of_four_stiffnesses())
    result.stability = msm::stability_range(result.design->stiffness, edge);
  return result;
}

/// [msm] of these stiffnesses.
cases::Msm given(const msm::CellStiffness& k) {
  cases::Msm options;
  options.design = cases::Design::given;
  options.stiffness = {1e3 * k.edge, 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal};
  options.volume_stiffness = k.volume;
  msm::set_law(options, k.exponents);
  return options;
}

DesignAttempt attempt(const std::string& name, msm::DesignRequest request, cases::Design method) {
  request.options.design = method;
  try {
    return designed(name, request);
  } catch (const cases::InputError& error) {
    return {name, std::nullopt, error.what()};
  } catch (const cases::SolveError& error) {
    return {name, std::nullopt, error.what()};
  }
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
  return fem && msm ? error_percent(*fem, *msm, 0) : std::nullopt;
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

std::optional<double> worst_if_stable(const CubeErrors& cube) {
  return cube.is_stable() ? cube.worst() : std::nullopt;
}

CubeErrors cube_errors(const std::vector<CubeSolve>& solves) {
  return {load_set_errors("small", solves), load_set_errors("large", solves)};
}

DesignAttempt attempt_one(const msm::DesignRequest& request) {
  return designed(cases::name_of(request.options.design), request);
}

std::vector<DesignAttempt> attempt_all(const msm::DesignRequest& request) {
  std::vector<DesignAttempt> attempts;
  for (const cases::Design method : msm::methods(request.material))
    attempts.push_back(attempt(cases::name_of(method), request, method));
  return attempts;
}

std::vector<DesignAttempt> attempt_springs(const msm::DesignRequest& request) {
  std::vector<DesignAttempt> attempts;
  for (const cases::Design method : {cases::Design::linear_method, cases::Design::nonlinear_method})
    attempts.push_back(attempt(cases::name_of(method), request, method));
  msm::DesignRequest springs = request;
  springs.options.has_volume_term = false;
  for (const double split : {0.2, 0.5, 0.8}) {
    springs.options.split = split;
    attempts.push_back(attempt(fmt::format("multi_load t={}", split), springs, cases::Design::multi_load));
  }
  for (const double split : {0.0, 0.2, 0.4, 0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9}) {
    springs.options.split = split;
    attempts.push_back(attempt(fmt::format("moduli t={}", split), springs, cases::Design::moduli));
  }
  return attempts;
}

void measure_on_cube(std::vector<DesignAttempt>& attempts, const msm::DesignRequest& request) {
  const double edge = msm::cube_edge(request.cell);
  if (!(edge > 0)) throw cases::InputError("--measure solves the thesis's cube, whose cells are cubes");
  std::vector<Comparison> fem;
  for (const CubeTest& test : cube_tests)
    fem.push_back(compare_case(cube_case(test, request.material, edge), {cases::Side::fem}));
  for (DesignAttempt& a : attempts) {
    if (!a.design) continue;
    const msm::CellStiffness& k = a.design->stiffness;
    std::list<Comparison> springs; // whose elements are referred to
    std::vector<CubeSolve> solves;
    for (const Comparison& test : fem) {
      cases::Case definition = test.scene.definition;
      definition.msm = a.design->terms ? a.options : given(k);
      springs.push_back(compare_case(definition, {cases::Side::msm}));
      solves.push_back({test, springs.back()});
    }
    a.cube = cube_errors(solves);
  }
}

const DesignAttempt* recommended(const std::vector<DesignAttempt>& attempts) {
  const DesignAttempt* best = nullptr;
  std::optional<double> least;
  for (const DesignAttempt& a : attempts) {
    const auto worst = a.cube ? worst_if_stable(*a.cube) : std::nullopt;
    if (!worst || (least && *worst >= *least)) continue;
    best = &a;
    least = worst;
  }
  return best;
}

double stable_strain(const msm::StabilityRange& range) {
  return std::min(std::log(range.stretch), -std::log(range.compression));
}

std::vector<bool> on_pareto_front(const std::vector<DesignAttempt>& attempts) {
  const auto is_measured = [](const DesignAttempt& a) { return a.stability && a.cube && a.cube->worst(); };
  std::vector<bool> front;
  for (const DesignAttempt& a : attempts)
    front.push_back(is_measured(a) &&
                    std::none_of(attempts.begin(), attempts.end(), [&](const DesignAttempt& b) {
                      return is_measured(b) && *b.cube->worst() < *a.cube->worst() &&
                             stable_strain(*b.stability) > stable_strain(*a.stability);
                    }));
  return front;
}

} // namespace springproof::compare
