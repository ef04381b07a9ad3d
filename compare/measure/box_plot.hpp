#pragma once

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
/// @param values  at least one, all finite, in any order
BoxPlot box_plot(std::vector<double> values);

/// Nothing without values.
std::optional<double> median(const std::vector<double>& values);

} // namespace springproof::compare
