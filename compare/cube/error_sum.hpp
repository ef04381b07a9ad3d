#pragma once

#include <cmath>
#include <optional>

namespace springproof::compare {

/// Worst and mean of |error|, in the unit of the errors.
struct ErrorSum {
  int n = 0;
  double total = 0;
  std::optional<double> worst;

  /// @param error  finite    @return whether it is the worst so far; of equal ones the first
  bool add(double error) {
    const double size = std::abs(error);
    ++n;
    total += size;
    if (worst && size <= *worst) return false;
    worst = size;
    return true;
  }
  std::optional<double> mean() const { return n > 0 ? std::optional(total / n) : std::nullopt; }
};

} // namespace springproof::compare
