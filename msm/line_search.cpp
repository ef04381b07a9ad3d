#include "msm/line_search.hpp"

#include <cmath>
#include <utility>

namespace springproof::msm {

bool line_search(EquilibriumSystem& system, Vector& at, const Vector& step, const Vector& before,
                 double load_factor) {
  const double start = system.potential(at, load_factor);
  const double slope = step.dot(before);
  for (double factor = 1; factor > 1e-6; factor /= 2) {
    Vector trial = at + factor * step;
    const double change = system.potential(trial, load_factor) - start;
    const bool in_rounding = factor * slope <= 1e-9 * (std::abs(start) + slope);
    if (change <= -1e-4 * factor * slope ||
        (in_rounding && system.imbalance(trial, load_factor).norm() < before.norm())) {
      at = std::move(trial);
      return true;
    }
  }
  return false;
}

double relative_imbalance(EquilibriumSystem& system, const Vector& imbalance, const Vector& at) {
  const double load = system.load().norm();
  const double scale = load > 0 ? load : system.reaction(at);
  return imbalance.norm() / (scale > 0 ? scale : 1.0);
}

} // namespace springproof::msm
