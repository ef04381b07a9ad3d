#include "compare/sweep/write_sweep.hpp"

#include "cases/case/names.hpp"
#include "compare/table/table.hpp"
#include "compare/write/gnuplot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace springproof::compare {

namespace {

/// Style of gnuplot; a marker of 0 is the linetype's own.
struct Appearance {
  int linetype = 0, marker = 0;
};

/// A method's points: those that a line joins through the resolutions, and the others.
struct Series {
  std::string method;
  Appearance appearance;
  std::optional<double> floor{}; ///< percent; springs
  std::vector<Point> joined{}, loose{};
  /// Adds a point; one without an error has no place on a logarithmic axis.
  void add(const Point& point, bool is_joined) {
    if (point.error_percent > 0) (is_joined ? joined : loose).push_back(point);
  }
};

struct ErrorPlot {
  std::string name;          ///< that of the pictures and their script
  std::string data;          ///< name of the data file
  std::string headline;      ///< above the picture
  std::string time = "time"; ///< what the times are
  std::string unit = "ms";   ///< in which they are drawn
  double unit_seconds = 1e-3;
  /// Time in the unit, where a line is drawn: models left of it are as fast as what they follow. 0: none is.
  double real_time = 0;
  double uncertainty = 0; ///< the reference's, percent
  std::vector<Series> series{};
  std::vector<Point> points{}; ///< whose Pareto front is drawn
};

/// Blocks of the data file: two per method, joined and loose, then the Pareto front. An empty one has a point
/// that is not drawn, so that the numbers stay.
void write_data(CsvWriter& csv, const ErrorPlot& plot) {
  const auto block = [&](const std::string& title, const std::vector<Point>& content) {
    csv.row("# " + title + ": " + plot.unit, "percent", "variant");
    for (const Point& p : content) csv.row(p.seconds / plot.unit_seconds, p.error_percent, p.name);
    if (content.empty()) csv.row("nan", "nan", "none");
    csv.end_block();
  };
  for (const Series& series : plot.series) {
    block(series.method, series.joined);
    block(series.method + " others", series.loose);
  }
  std::vector<Point> front = pareto_front(plot.points);
  if (!front.empty() && !(front.back().error_percent > 0)) front.pop_back();
  block("Pareto front", front);
}

PlotValues values_of(const ErrorPlot& plot) {
  std::vector<std::string> methods;
  std::vector<double> linetypes, markers, floors;
  double least = std::numeric_limits<double>::infinity(); // error that is drawn
  for (const Series& series : plot.series) {
    methods.push_back(series.joined.empty() ? "" : series.method); // what has no line has no title
    linetypes.push_back(series.appearance.linetype);
    markers.push_back(series.appearance.marker);
    floors.push_back(series.floor.value_or(0));
    for (const auto* points : {&series.joined, &series.loose})
      for (const Point& p : *points) least = std::min(least, p.error_percent);
  }
  // A much smaller uncertainty would leave no room for the errors.
  const double bottom = 0.7 * std::clamp(plot.uncertainty, least / 10, least);
  return {{"headline", plot.headline},
          {"points", plot.data},
          {"time_label", plot.time + ", " + plot.unit},
          {"real_time", plot.real_time},
          {"methods", methods},
          {"linetypes", linetypes},
          {"markers", markers},
          {"floors", floors},
          {"uncertainty", plot.uncertainty},
          {"bottom", bottom},
          {"width", 1200.},
          {"height", 700.}};
}

/// Draws FOLDER/NAME.svg and .png with the Pareto front, the reference's uncertainty and the floors. Nothing
/// for a plot without points.
/// @throws InputError as draw()
void plot_errors(const std::string& folder, const ErrorPlot& plot) {
  if (std::all_of(plot.series.begin(), plot.series.end(),
                  [](const Series& series) { return series.joined.empty() && series.loose.empty(); }))
    return;
  write_csv_file(
      folder + "/" + plot.data, [&](CsvWriter& csv) { write_data(csv, plot); }, 6);
  draw(folder, plot.name, "sweep", values_of(plot));
}

#pragma GCC diagnostic error "-Wswitch" // an element without its marker must not compile
int marker_of(cases::Element element) {
  switch (element) {
  case cases::Element::q1:
    return 4;
  case cases::Element::q1_bbar:
  case cases::Element::q1_p0: // the same on a grid's cells
    return 6;
  case cases::Element::q1_wilson:
    return 8;
  case cases::Element::p1:
    return 10;
  case cases::Element::q2:
  case cases::Element::q2_p1:
  case cases::Element::p2:
  case cases::Element::p2_p0:
  case cases::Element::p2_p1:
    break;
  }
  return 12;
}

/// Springs have the linetypes 2 to 6, 9 and 8, a colour each; designs of others the thin grey lines of 10
/// with a marker each. The finite elements have linetype 1 (small strain, and every motion), 7 (finite
/// strain) and 8 (CalculiX), an element its marker.
/// @param number  that of the design among ours, or among those of others
Appearance appearance(const Variant& v, int number) {
  constexpr std::array ours{2, 3, 4, 5, 6, 9, 8};
  constexpr std::array markers{4, 6, 8, 10, 12, 14};
  if (v.program == Program::springs && cases::is_of_others(v.design))
    return {10, markers.at(cases::index(number) % markers.size())};
  if (v.program == Program::springs) return {ours.at(cases::index(number) % ours.size())};
  if (v.step > 0) return {1};
  if (v.program == Program::calculix) return {8, 1 + static_cast<int>(v.formulation)};
  return {v.formulation == cases::Formulation::small_strain ? 1 : 7, marker_of(v.element)};
}

/// The points of every method: joined are those that all methods have, of the tightest tolerance, or with the
/// case's own step.
std::vector<Series> series_of(const Sweep& sweep, Error error, Clock clock) {
  std::vector<Series> all;
  std::array<int, 2> n_designs{}; // ours, and of others
  const auto& dynamics = sweep.definition.dynamics;
  for (const std::string& method : methods_of(sweep)) {
    std::vector<const SweepRow*> rows;
    double tightest = 1;
    for (const SweepRow& row : sweep.rows) {
      if (method_name(row.variant) != method) continue;
      rows.push_back(&row);
      tightest = std::min(tightest, row.variant.tolerance);
    }
    const Variant& first = rows.front()->variant;
    int& n_alike = n_designs.at(cases::is_of_others(first.design) ? 1 : 0);
    Series series{method, appearance(first, n_alike)};
    if (first.program == Program::springs) {
      ++n_alike;
      if (!dynamics) series.floor = errors_by_level(sweep, method, error).back();
    }
    for (const SweepRow* row : rows)
      if (const auto point = point_of(sweep, *row, error, clock))
        series.add(*point, dynamics ? std::abs(row->variant.step - dynamics->step) < 1e-9 * dynamics->step
                                    : row->variant.tolerance == tightest);
    if (dynamics || !series.joined.empty() || !series.loose.empty()) all.push_back(series);
  }
  return all;
}

ErrorPlot plot_of(const Sweep& sweep, Error error, Clock clock) {
  ErrorPlot plot;
  plot.uncertainty = uncertainty_percent(*sweep.reference, error);
  plot.series = series_of(sweep, error, clock);
  plot.points = points_of(sweep, error, clock);
  return plot;
}

/// A series for each method of real time, whose line joins those that no other of its points beats.
void plot_at_rate(const std::string& folder, const Sweep& sweep) {
  ErrorPlot plot;
  plot.uncertainty = uncertainty_percent(*sweep.reference, Error::field);
  plot.points = points_of(sweep, Error::field, Clock::first_answer);
  for (const std::string& method : method_names()) {
    Series series{method, {2 + static_cast<int>(plot.series.size())}};
    std::vector<Point> own;
    for (const SweepRow& row : sweep.rows)
      if (row.variant.real_time && name_of(method_of(*row.variant.real_time)) == method)
        if (const auto point = point_of(sweep, row, Error::field, Clock::first_answer)) own.push_back(*point);
    for (const Point& point : pareto_front(own)) series.add(point, true);
    for (const Point& point : own) series.add(point, false);
    plot.series.push_back(series);
  }
  plot.name = "rate_sweep";
  plot.data = "rate_sweep_points.csv";
  plot.headline = fmt::format("{}: a frame on one thread, and its time at {:g} Hz", sweep.definition.name,
                              sweep.rate->hertz);
  plot.time = "a frame";
  plot.real_time = 1e3 / sweep.rate->hertz;
  plot_errors(folder, plot);
}

void plot_motions(const std::string& folder, const Sweep& sweep) {
  const double ms = 1e3 * sweep.definition.dynamics->step;
  ErrorPlot plot = plot_of(sweep, Error::field, Clock::first_answer);
  plot.name = "motion_sweep";
  plot.data = "motion_sweep_points.csv";
  plot.headline =
      fmt::format("{}: motions on one thread; lines: steps of {:g} ms, small marks: {:g} and {:g} ms",
                  sweep.definition.name, ms, step_factors[0] * ms, step_factors[2] * ms);
  plot.time = "computing for a second of motion";
  plot.unit = "s";
  plot.unit_seconds = plot.real_time = 1;
  plot_errors(folder, plot);
}

} // namespace

void plot_sweep(const std::string& folder, const Sweep& sweep) {
  if (!sweep.reference) return;
  if (sweep.rate) return plot_at_rate(folder, sweep);
  if (sweep.definition.dynamics) return plot_motions(folder, sweep);
  for (const Error error : {Error::field, Error::worst_measure})
    for (const Clock clock : {Clock::first_answer, Clock::re_solve}) {
      ErrorPlot plot = plot_of(sweep, error, clock);
      plot.name = fmt::format("{}_{}", error == Error::field ? "field" : "measures",
                              clock == Clock::first_answer ? "first" : "again");
      plot.data = plot.name + ".csv";
      plot.headline = fmt::format("{}: {}, {}", sweep.definition.name, what(error), what(clock));
      plot_errors(folder, plot); // which has no points of a case without measures, for one
    }
}

} // namespace springproof::compare
