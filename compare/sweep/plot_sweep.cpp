#include "compare/sweep/write_sweep.hpp"
#include "compare/write/gnuplot.hpp"
#include "compare/write/whole_file.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <limits>

namespace springproof::compare {

namespace {

struct Picture {
  Error error;
  Clock clock;
  const char *name, *title;
};
constexpr Picture pictures[] = {
    {Error::field, Clock::first_answer, "field_first", "displacement field, first answer (setup and solve)"},
    {Error::field, Clock::re_solve, "field_again", "displacement field, re-solve after a load change of 5 %"},
    {Error::worst_measure, Clock::first_answer, "measures_first",
     "worst measure, first answer (setup and solve)"},
    {Error::worst_measure, Clock::re_solve, "measures_again",
     "worst measure, re-solve after a load change of 5 %"}};

/// Springs have the linetypes from 2 on, a colour each; the finite elements those of 1 (small strain), 7
/// (finite strain) and 8 (CalculiX), an element its marker.
std::string appearance(const Variant& v, int design_number) {
  if (v.program == Program::springs) return fmt::format("lt {}", 2 + design_number % 5);
  if (v.program == Program::calculix) return fmt::format("lt 8 pt {}", 1 + static_cast<int>(v.formulation));
  const int marker = v.element == cases::Element::q1 ? 4 : v.element == cases::Element::q1_bbar ? 6 : 12;
  return fmt::format("lt {} pt {}", v.formulation == cases::Formulation::small_strain ? 1 : 7, marker);
}

/// A method's points: those of the tightest tolerance, which a line joins through the resolutions, and the
/// others.
struct Series {
  std::string method, appearance;
  std::optional<double> floor; ///< percent; springs
  std::vector<Point> tight, loose;
};

std::vector<Series> series_of(const Sweep& sweep, const Picture& picture) {
  std::vector<Series> all;
  int n_designs = 0;
  for (const std::string& method : methods_of(sweep)) {
    Series series{method, "", std::nullopt, {}, {}};
    double tightest = 1;
    for (const SweepRow& row : sweep.rows)
      if (method_name(row.variant) == method) tightest = std::min(tightest, row.variant.tolerance);
    for (const SweepRow& row : sweep.rows) {
      if (method_name(row.variant) != method) continue;
      if (series.appearance.empty()) {
        series.appearance = appearance(row.variant, n_designs);
        if (row.variant.program == Program::springs) {
          ++n_designs;
          series.floor = errors_by_level(sweep, method, picture.error).back();
        }
      }
      const auto seconds = median_seconds(row, picture.clock), error = error_of(row, picture.error);
      if (!seconds || !error || !(*error > 0)) continue; // zero has no place on a logarithmic axis
      (row.variant.tolerance == tightest ? series.tight : series.loose)
          .push_back({full_name(row.variant), family_of(row.variant), *seconds, *error});
    }
    if (!series.tight.empty() || !series.loose.empty()) all.push_back(series);
  }
  return all;
}

/// Blocks of the data file: two per method, tight and loose, then the Pareto front. An empty one has a point
/// that is not drawn, so that the numbers stay.
void write_data(std::ostream& out, const std::vector<Series>& all, const std::vector<Point>& points) {
  const auto block = [&](const std::string& title, const std::vector<Point>& content) {
    fmt::print(out, "# {}: ms,percent,variant\n", title);
    for (const Point& p : content)
      fmt::print(out, "{:.6g},{:.6g},{}\n", 1e3 * p.seconds, p.error_percent, p.name);
    if (content.empty()) fmt::print(out, "nan,nan,none\n");
    fmt::print(out, "\n\n");
  };
  for (const Series& series : all) {
    block(series.method, series.tight);
    block(series.method + ", looser tolerances", series.loose);
  }
  std::vector<Point> front;
  for (const std::size_t i : pareto_front(points))
    if (points[i].error_percent > 0) front.push_back(points[i]);
  block("Pareto front", front);
}

std::string script_of(const Sweep& sweep, const Picture& picture, const std::vector<Series>& all,
                      const std::string& data) {
  std::string script = fmt::format(
      "set title '{}: {}' noenhanced\nset logscale xy\nset xlabel 'time, ms'\nset ylabel 'error, %'\n"
      "set key outside right noenhanced\nset format x '%g'\nset format y '%g'\n",
      sweep.definition.name, picture.title);
  double least = std::numeric_limits<double>::infinity(); // error that is drawn
  for (const Series& series : all)
    for (const auto* points : {&series.tight, &series.loose})
      for (const Point& p : *points) least = std::min(least, p.error_percent);
  const double uncertainty = uncertainty_percent(*sweep.reference, picture.error);
  // A much smaller uncertainty would leave no room for the errors.
  const double bottom = 0.7 * std::clamp(uncertainty, least / 10, least);
  script += fmt::format("set yrange [{:.6g}:*]\n", bottom);
  if (uncertainty > bottom)
    script +=
        fmt::format("set object rectangle from graph 0, graph 0 to graph 1, first {:.6g} fc rgb '#dddddd' "
                    "fs solid noborder behind\n",
                    uncertainty);
  for (const Series& series : all)
    if (series.floor && *series.floor > 0)
      script += fmt::format(
          "set arrow from graph 0, first {0:.6g} to graph 1, first {0:.6g} nohead {1} lw 1 dt 3\n",
          *series.floor, series.appearance);
  std::string curves;
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (!all[s].tight.empty())
      curves += fmt::format("'{}' index {} using 1:2 with linespoints {} title '{}', ", data, 2 * s,
                            all[s].appearance, all[s].method);
    if (!all[s].loose.empty())
      curves += fmt::format("'{}' index {} using 1:2 with points {} ps 0.6 notitle, ", data, 2 * s + 1,
                            all[s].appearance);
  }
  return script +
         fmt::format(
             "plot {0}'{1}' index {2} using 1:2 with steps lw 3 lc rgb '#000000' dt solid title 'Pareto "
             "front', NaN with boxes fc rgb '#dddddd' fs solid title 'uncertainty of the reference', "
             "NaN with lines lc rgb '#777777' dt 3 title 'floor of a design'\n",
             curves, data, 2 * all.size());
}

} // namespace

std::vector<std::string> plot_sweep(const std::string& folder, const Sweep& sweep) {
  std::vector<std::string> drawn;
  if (!sweep.reference) return drawn;
  for (const Picture& picture : pictures) {
    const std::vector<Series> all = series_of(sweep, picture);
    if (all.empty()) continue; // such as a case without measures
    const std::string data = std::string(picture.name) + ".csv";
    write_file(folder + "/" + data, [&](std::ostream& out) {
      write_data(out, all, points_of(sweep, picture.error, picture.clock));
    });
    draw(folder, picture.name, script_of(sweep, picture, all, data), 1200, 700);
    drawn.emplace_back(picture.name);
  }
  return drawn;
}

} // namespace springproof::compare
