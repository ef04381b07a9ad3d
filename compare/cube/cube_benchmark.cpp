#include "compare/cube/cube_benchmark.hpp"

#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/provenance/machine.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

namespace springproof::compare {

namespace {

std::string why(const char* side, const cases::Solution& failed) {
  const std::string reached = fmt::format(" (reached: {:.2f} of the load)", failed.load_reached);
  return fmt::format("{}: {}{}", side, failed.message, failed.load_reached > 0 ? reached : "");
}

LoadSetErrors load_set_errors(const std::string& load_set, const std::vector<Comparison>& tests) {
  LoadSetErrors errors;
  WorstError lengths_and_angles, volumes;
  for (std::size_t t = 0; t < cube_tests.size(); ++t) {
    if (cube_tests[t].load_set != load_set) continue;
    const Comparison& test = tests.at(t);
    const std::string reason = why_without_errors(test.answers, test.answers);
    errors.is_stable = errors.is_stable && is_stable(test.answers.msm.solution);
    for (std::size_t m = 0; m < test.measures.size(); ++m) {
      const auto& [name, error] = std::tie(test.measures[m].name, test.measures[m].error_same_mesh_percent);
      errors.measures.push_back({test.scene.definition.name, name, error, reason});
      if (!error && errors.failure.empty())
        errors.failure = fmt::format("{} {}: {}", load_set, cube_tests[t].test, reason);
      if (!error) continue;
      const bool is_volume = cases::is<cases::measures::Volume>(test.scene.definition.measures[m]);
      (is_volume ? volumes : lengths_and_angles).add(*error, t);
    }
  }
  if (!errors.failure.empty()) return errors;
  errors.worst = lengths_and_angles.worst;
  errors.worst_test = lengths_and_angles.place;
  errors.mean = lengths_and_angles.mean();
  errors.worst_volume = volumes.worst;
  return errors;
}

/// [msm] of the attempt's springs, whose fits are not repeated, but for a law that forces on nodes ask for.
cases::Msm fitted(const DesignAttempt& attempt, const cases::Material& material) {
  cases::Msm options = attempt.options;
  cases::settle_law(options, {material}, true);
  const bool is_other_law =
      attempt.design->stiffness.exponents && cases::law_of(options, material) == cases::SpringLaw::hooke;
  if (!attempt.design->springs.cells() || is_other_law) return options;
  const msm::CellStiffness& k = attempt.design->stiffness;
  if (k.midline == 0) {
    options = {};
    options.design = cases::Design::given;
    options.stiffness = scaled(k, 1e3).springs();
    options.volume_stiffness = k.volume;
  }
  msm::set_law(options, k.exponents);
  return options;
}

DesignAttempt attempt(const std::string& name, msm::DesignRequest request, cases::Design method) {
  request.options.design = method;
  try {
    return attempt_of(name, msm::design(request), request.options, request.cell);
  } catch (const cases::InputError& error) {
    return {name, std::nullopt, error.what()};
  } catch (const cases::SolveError& error) {
    return {name, std::nullopt, error.what()};
  }
}

} // namespace

std::string why_without_errors(const Answers& fem, const Answers& msm) {
  if (!fem.fem.converged()) return why("finite elements", fem.fem.solution);
  return msm.msm.converged() ? "" : why("springs", msm.msm.solution);
}

cases::Case cube_case(const CubeTest& test, const cases::Material& material, double edge) {
  const bool is_hyperelastic = cases::is_hyperelastic(material);
  cases::Case definition =
      cases::read_case(fmt::format("{}/thesis/{}/cube_{}_{}.toml", cases_folder(),
                                   is_hyperelastic ? "ogden" : "linear_elastic", test.test, test.load_set));
  const double scale = msm::small_strain_material(material).youngs_modulus /
                       msm::small_strain_material(definition.material).youngs_modulus * edge * edge;
  definition.material = material;
  std::get<cases::Box>(definition.body).size *= edge; // from cells of 1 mm
  for (cases::Load& load : definition.loads) load.scale(scale);
  for (cases::Measure& measure : definition.measures)
    cases::for_each_region(measure, [&](cases::Region& region, bool) {
      if (region.near) *region.near *= edge;
    });
  return definition;
}

CubeErrors cube_errors(const std::vector<Comparison>& tests) {
  return {load_set_errors("small", tests), load_set_errors("large", tests)};
}

DesignAttempt attempt_of(const std::string& name, const msm::DesignResult& design, const cases::Msm& options,
                         const msm::CellVertices& cell) {
  DesignAttempt attempt{name, design};
  attempt.options = options;
  if (const double edge = msm::cube_edge(cell); edge > 0 && design.is_of_four_stiffnesses())
    attempt.stability = msm::stability_range(design.stiffness, edge);
  return attempt;
}

DesignAttempt attempt_one(const msm::DesignRequest& request) {
  return attempt_of(cases::name_of(request.options.design), msm::design(request), request.options,
                    request.cell);
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
  std::vector<std::pair<cases::Scene, Answers>> tests;
  for (const CubeTest& test : cube_tests) {
    cases::Scene scene = cases::make_scene(cube_case(test, request.material, edge));
    Answers fem = solve_reference(scene);
    tests.emplace_back(std::move(scene), std::move(fem));
  }
  if (mpi_rank() != 0) return;
  for (DesignAttempt& a : attempts) {
    if (!a.design) continue;
    std::vector<Comparison> tried;
    for (auto& [scene, fem] : tests) {
      scene.definition.msm = fitted(a, request.material);
      a.has_law_of_cube =
          a.design->stiffness.exponents && scene.definition.msm.law == cases::SpringLaw::hooke;
      tried.push_back(try_springs(scene, fem));
    }
    a.cube = cube_errors(tried);
  }
}

const DesignAttempt* recommended(const std::vector<DesignAttempt>& attempts) {
  std::vector<Standing> standings;
  for (const DesignAttempt& a : attempts) standings.push_back(a.cube ? a.cube->standing() : Standing{});
  const auto found = recommended_of(standings);
  return found ? &attempts[*found] : nullptr;
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
