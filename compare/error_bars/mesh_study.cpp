#include "compare/error_bars/mesh_study.hpp"

#include "compare/measure/measure.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace springproof::compare {

MeshVerdict judge_refinement(const std::vector<double>& coarse_to_fine, double ratio, double resolved) {
  assert(coarse_to_fine.size() >= 3 && ratio > 1);
  const std::size_t n = coarse_to_fine.size();
  const double f1 = coarse_to_fine[n - 1], f2 = coarse_to_fine[n - 2], f3 = coarse_to_fine[n - 3];
  const double last = f1 - f2, before = f2 - f3;
  if (!std::isfinite(last) || !std::isfinite(before)) return "a value is not finite";
  if (f1 == 0) return "the value is zero, and the error is relative to it";
  const double scale = std::max({std::abs(f1), std::abs(f2), std::abs(f3)});
  if (std::abs(last) <= resolved * scale)
    return fmt::format("the two finest meshes agree to {:.0e}: there is nothing to extrapolate from",
                       resolved);
  if (last * before < 0)
    return fmt::format("the values oscillate: {:.6g}, {:.6g}, {:.6g} from coarse to fine", f3, f2, f1);
  if (!(std::abs(last) < std::abs(before)))
    return fmt::format("the values do not draw nearer: {:.6g}, {:.6g}, {:.6g} from coarse to fine", f3, f2,
                       f1);
  MeshLimit limit{};
  limit.order = std::log(before / last) / std::log(ratio);
  limit.extrapolated = f1 + last / (std::pow(ratio, limit.order) - 1);
  limit.index_percent = discretisation_error_percent(f1, limit);
  return limit;
}

double discretisation_error_percent(double value, const MeshLimit& limit) {
  constexpr double safety_factor = 1.25; // Roache's, for three meshes and more
  return 100 * safety_factor * std::abs((value - limit.extrapolated) / value);
}

double finest_error_percent(const std::vector<double>& coarse_to_fine, double ratio) {
  assert(coarse_to_fine.size() >= 2 && ratio > 1);
  if (coarse_to_fine.size() >= 3) {
    const MeshVerdict verdict = judge_refinement(coarse_to_fine, ratio);
    if (const auto* limit = std::get_if<MeshLimit>(&verdict)) return limit->index_percent;
  }
  constexpr double two_mesh_safety_factor = 3;
  const double f1 = coarse_to_fine.back(), f2 = coarse_to_fine[coarse_to_fine.size() - 2];
  const double error = 100 * two_mesh_safety_factor * std::abs((f1 - f2) / f1) / (ratio - 1);
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

MeshStudy study_meshes(const cases::Scene& scene, const Answers& answers) {
  const RefinedMeshes& meshes = answers.refined.value();
  MeshStudy study;
  for (const cases::Measure& measure : scene.definition.measures)
    study.measures.push_back({measure.name, {}, std::nullopt, std::nullopt, meshes.reason});
  if (!meshes.reason.empty()) return study;
  study.refine = meshes.refine;
  const auto own = static_cast<std::size_t>(answers.resolved.refine - study.refine.front());
  for (const cases::Solution& solution : meshes.solutions) study.unknowns.push_back(solution.unknowns);
  for (std::size_t m = 0; m < study.measures.size(); ++m) {
    StudiedMeasure& measure = study.measures[m];
    for (const cases::Solution& solution : meshes.solutions)
      measure.values.push_back(evaluate(scene.definition.measures[m], scene, solution));
    const MeshVerdict verdict = judge_refinement(measure.values, 2);
    if (const auto* limit = std::get_if<MeshLimit>(&verdict)) {
      measure.limit = *limit;
      measure.discretisation_error_percent = discretisation_error_percent(measure.values[own], *limit);
    } else {
      measure.reason = std::get<std::string>(verdict);
    }
  }
  return study;
}

} // namespace springproof::compare
