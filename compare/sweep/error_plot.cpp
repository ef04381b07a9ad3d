#include "compare/sweep/error_plot.hpp"

#include "compare/table/table.hpp"
#include "compare/write/gnuplot.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace springproof::compare {

namespace {

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
  std::vector<Point> front;
  for (const std::size_t i : pareto_front(plot.points))
    if (plot.points[i].error_percent > 0) front.push_back(plot.points[i]);
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
          {"real_time", plot.real_time.value_or(0)},
          {"methods", methods},
          {"linetypes", linetypes},
          {"markers", markers},
          {"floors", floors},
          {"uncertainty", plot.uncertainty},
          {"bottom", bottom},
          {"width", 1200.},
          {"height", 700.}};
}

} // namespace

Appearance appearance_of_springs(cases::Design design, int number) {
  constexpr std::array ours{2, 3, 4, 5, 6, 9, 8};
  constexpr std::array markers{4, 6, 8, 10, 12, 14};
  if (cases::is_of_others(design)) return {10, markers.at(cases::index(number) % markers.size())};
  return {ours.at(cases::index(number) % ours.size())};
}

void Series::add(const Point& point, bool is_joined) {
  if (point.error_percent > 0) (is_joined ? joined : loose).push_back(point);
}

void plot_errors(const std::string& folder, const ErrorPlot& plot) {
  if (std::all_of(plot.series.begin(), plot.series.end(),
                  [](const Series& series) { return series.joined.empty() && series.loose.empty(); }))
    return;
  write_csv_file(
      folder + "/" + plot.data, [&](CsvWriter& csv) { write_data(csv, plot); }, 6);
  draw(folder, plot.name, "sweep", values_of(plot));
}

} // namespace springproof::compare
