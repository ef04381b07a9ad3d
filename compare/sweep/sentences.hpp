#pragma once

#include "compare/sweep/sweep.hpp"

namespace springproof::compare {

/// A time for reading: "0.41 ms", "16 ms", "2.5 s".
std::string time_text(double seconds);

/// At an error: which model is fastest, and by what factor over the fastest of the other family.
/// @param uncertainty_percent  the reference's own; no model can be told to be within less
std::string fastest_sentence(const std::vector<Point>& points, double error_percent,
                             double uncertainty_percent);

/// At a time: which model is most accurate.
std::string most_accurate_sentence(const std::vector<Point>& points, double seconds,
                                   double uncertainty_percent);

/// Where more cells stop helping a design.
/// @param levels  names of the resolutions, coarse to fine     @param errors  percent, one per level
std::string floor_sentence(const std::string& design, const std::vector<std::string>& levels,
                           const std::vector<std::optional<double>>& errors);

/// An error is at its floor when it is within this fraction of the one with the most cells.
constexpr double floor_fraction = 0.1;

/// What a sweep's numbers say, grouped: a heading and its sentences.
struct Conclusions {
  std::string heading;
  std::vector<std::string> sentences;
};
/// For both errors and both clocks: the fastest at 10, 5 and 1 per cent, the most accurate in 1, 16 and 100
/// ms; and for each error where more cells stop helping the springs.
std::vector<Conclusions> conclusions(const Sweep& sweep);

} // namespace springproof::compare
