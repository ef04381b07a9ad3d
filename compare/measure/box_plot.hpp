#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <vector>

namespace springproof::compare {

/// The figures of a box plot. Whiskers end at the outermost values within 1.5 interquartile ranges of the
/// box; what lies beyond is an outlier. Source: thesis section 5.3.1.3 (figure 5.10).
struct BoxPlot {
  double lower_quartile, median, upper_quartile;
  double lower_whisker, upper_whisker;
  std::vector<double> outliers; ///< ascending
};

/// Quantile p of n sorted values lies at position p n + 1/2, counted from 1, linearly interpolated (Hyndman
/// and Fan's fifth rule, that of the program that drew the thesis's figures).
inline double quantile(const std::vector<double>& sorted, double p) {
  const double last = static_cast<double>(sorted.size() - 1);
  const double position = std::clamp(p * static_cast<double>(sorted.size()) - 0.5, 0.0, last);
  const std::size_t below = static_cast<std::size_t>(std::floor(position));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - std::floor(position)) * (sorted[above] - sorted[below]);
}

/// @param values  at least one, all finite, in any order
inline BoxPlot box_plot(std::vector<double> values) {
  assert(!values.empty());
  std::sort(values.begin(), values.end());
  BoxPlot box{quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75), 0, 0, {}};
  const double reach = 1.5 * (box.upper_quartile - box.lower_quartile);
  const auto first = std::find_if(values.begin(), values.end(),
                                  [&](double value) { return value >= box.lower_quartile - reach; });
  const auto end =
      std::find_if(first, values.end(), [&](double value) { return value > box.upper_quartile + reach; });
  box.lower_whisker = *first;
  box.upper_whisker = *(end - 1);
  box.outliers.assign(values.begin(), first);
  box.outliers.insert(box.outliers.end(), end, values.end());
  return box;
}

/// Nothing without values.
inline std::optional<double> median(const std::vector<double>& values) {
  return values.empty() ? std::nullopt : std::optional(box_plot(values).median);
}

} // namespace springproof::compare
