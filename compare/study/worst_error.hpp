#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

namespace springproof::compare {

/// Worst and mean of |error| over errors that are added one by one: of measures, tests, figures or modes.
/// Every worst error of the program is found here.
struct WorstError {
  int n = 0;
  double total = 0;
  std::optional<double> worst{};
  std::size_t place = 0; ///< place of the worst, as its caller counts

  /// @param error  finite    @return whether it is the worst so far; of equal ones the first
  bool add(double error, std::size_t at = 0) {
    const double size = std::abs(error);
    ++n;
    total += size;
    if (worst && size <= *worst) return false;
    worst = size;
    place = at;
    return true;
  }
  std::optional<double> mean() const { return n > 0 ? std::optional(total / n) : std::nullopt; }
};

} // namespace springproof::compare
