#include "compare/measure/box_plot.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace springproof::compare {

namespace {

double quantile(const std::vector<double>& sorted, double p) {
  const double last = static_cast<double>(sorted.size() - 1);
  const double position = std::clamp(p * static_cast<double>(sorted.size()) - 0.5, 0.0, last);
  const std::size_t below = static_cast<std::size_t>(std::floor(position));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - std::floor(position)) * (sorted[above] - sorted[below]);
}

} // namespace

BoxPlot box_plot(std::vector<double> values) {
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

std::optional<double> median(const std::vector<double>& values) {
  return values.empty() ? std::nullopt : std::optional(box_plot(values).median);
}

} // namespace springproof::compare
