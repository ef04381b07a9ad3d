#include "compare/cube/design_study.hpp"

#include "cases/case/names.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <list>

namespace springproof::compare {

namespace {

DesignAttempt designed(const std::string& name, const msm::DesignRequest& request) {
  DesignAttempt result{name, msm::design(request)};
  const double edge = msm::cube_edge(request.cell);
  if (edge > 0) result.stability = msm::stability_range(result.design->stiffness, edge);
  return result;
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

cases::Msm given(const msm::CellStiffness& k) {
  cases::Msm springs;
  springs.design = cases::Design::given;
  springs.stiffness = {1e3 * k.edge, 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal};
  springs.volume_stiffness = k.volume;
  return springs;
}

} // namespace

DesignAttempt attempt_one(const msm::DesignRequest& request) {
  return designed(cases::name_of(request.options.design), request);
}

std::vector<DesignAttempt> attempt_all(const msm::DesignRequest& request) {
  std::vector<DesignAttempt> attempts;
  for (const cases::Design method : msm::methods())
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
    std::list<Comparison> msm; // whose elements are referred to
    std::vector<CubeSolve> solves;
    for (const Comparison& test : fem) {
      cases::Case definition = test.scene.definition;
      definition.msm = given(a.design->stiffness);
      msm.push_back(compare_case(definition, {cases::Side::msm}));
      solves.push_back({test, msm.back()});
    }
    a.cube = cube_errors(solves);
  }
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
