#pragma once

#include "compare/sweep/analysis.hpp"

/// Error against time, log-log: the figure of every sweep.
namespace springproof::compare {

/// Of gnuplot; a marker of 0 is the linetype's own.
struct Appearance {
  int linetype = 0, marker = 0;
};

/// Springs have the linetypes 2 to 6, 9 and 8, a colour each; designs of others the thin grey lines of 10
/// with a marker each. The finite elements have those that are left.
/// @param number  of the design among ours, or among those of others
Appearance appearance_of_springs(cases::Design design, int number);

/// A method's points: those that a line joins through the resolutions, and the others.
struct Series {
  std::string method;
  Appearance appearance;
  std::optional<double> floor{}; ///< percent; springs
  std::vector<Point> joined{}, loose{};
  /// Adds a point; one without an error has no place on a logarithmic axis.
  void add(const Point& point, bool is_joined);
};

struct ErrorPlot {
  std::string name;     ///< of the pictures and their script
  std::string data;     ///< name of the data file
  std::string headline; ///< of the picture
  std::string time;     ///< what the times are
  std::string unit;     ///< in which they are drawn
  double unit_seconds = 1;
  /// In the unit: where a line is drawn, of the times that keep up with what they are of.
  std::optional<double> real_time{};
  double uncertainty = 0; ///< of the reference, percent
  std::vector<Series> series{};
  std::vector<Point> points{}; ///< whose Pareto front is drawn
};

/// FOLDER/NAME.svg and .png with the Pareto front, the reference's uncertainty and the floors. Nothing for a
/// plot without points.
/// @throws InputError as draw()
void plot_errors(const std::string& folder, const ErrorPlot& plot);

} // namespace springproof::compare
