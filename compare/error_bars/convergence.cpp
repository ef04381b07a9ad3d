#include "compare/error_bars/convergence.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace springproof::compare {

namespace {

constexpr double safety_factor = 1.25; ///< Roache's, for three meshes and more

} // namespace

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

} // namespace springproof::compare
