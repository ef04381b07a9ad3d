#include "compare/cube/design_study.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/mpi_rank.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

void add_stability(DesignAttempt& attempt, const msm::DesignRequest& request) {
  const double edge = msm::cube_edge(request.cell);
  if (attempt.design && edge > 0) attempt.stability = msm::stability_range(attempt.design->stiffness, edge);
}

DesignAttempt attempt(const std::string& name, const msm::DesignRequest& request) {
  DesignAttempt result{name, std::nullopt, "", std::nullopt, std::nullopt};
  try {
    result.design = msm::design(request);
  } catch (const cases::InputError& error) {
    result.refusal = error.what();
  } catch (const cases::SolveError& error) {
    result.refusal = error.what();
  }
  add_stability(result, request);
  return result;
}

DesignAttempt attempt(const std::string& name, msm::DesignRequest request, cases::Design method) {
  request.options.design = method;
  return attempt(name, request);
}

} // namespace

DesignAttempt attempt_one(const msm::DesignRequest& request) {
  DesignAttempt result{cases::name_of(request.options.design), msm::design(request), "", std::nullopt,
                       std::nullopt};
  add_stability(result, request);
  return result;
}

std::vector<DesignAttempt> attempt_all(const msm::DesignRequest& request) {
  std::vector<DesignAttempt> attempts;
  for (const auto& [method, name] : cases::names<cases::Design>())
    if (method != cases::Design::given) attempts.push_back(attempt(name, request, method));
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
  if (!(std::abs(msm::cube_edge(request.cell) - 1) <= 1e-12))
    throw cases::InputError("the cube of the thesis has cells of 1 mm: measure with --edge 1");
  const bool is_ogden = std::holds_alternative<cases::Ogden>(request.material);
  const CubeReference reference =
      solve_cube_reference(request.material, is_ogden ? LoadSets::small_and_large : LoadSets::small);
  const int rank = mpi_rank();
  if (rank != 0) return;
  for (DesignAttempt& a : attempts)
    if (a.design) a.cube = cube_errors(reference, a.design->stiffness);
}

double stable_strain(const msm::StabilityRange& range) {
  return std::min(std::log(range.stretch), -std::log(range.compression));
}

std::vector<bool> on_pareto_front(const std::vector<DesignAttempt>& attempts) {
  const auto is_measured = [](const DesignAttempt& a) { return a.stability && a.cube && a.cube->worst(); };
  std::vector<bool> front;
  for (const DesignAttempt& a : attempts) {
    const bool beaten =
        is_measured(a) && std::any_of(attempts.begin(), attempts.end(), [&](const DesignAttempt& b) {
          return is_measured(b) && *b.cube->worst() < *a.cube->worst() &&
                 stable_strain(*b.stability) > stable_strain(*a.stability);
        });
    front.push_back(is_measured(a) && !beaten);
  }
  return front;
}

} // namespace springproof::compare
