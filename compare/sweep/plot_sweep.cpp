#include "compare/sweep/plot_sweep.hpp"

#include "compare/provenance/whole_file.hpp"
#include "compare/write/csv.hpp"
#include "compare/write/gnuplot.hpp"

#include <algorithm>
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

/// Of gnuplot; a marker of 0 is the linetype's own.
struct Appearance {
  int linetype = 0, marker = 0;
};

/// Springs have the linetypes from 2 on, a colour each; the finite elements those of 1 (small strain), 7
/// (finite strain) and 8 (CalculiX), an element its marker.
Appearance appearance(const Variant& v, int design_number) {
  if (v.program == Program::springs) return {2 + design_number % 5};
  if (v.program == Program::calculix) return {8, 1 + static_cast<int>(v.formulation)};
  const int marker = v.element == cases::Element::q1 ? 4 : v.element == cases::Element::q1_bbar ? 6 : 12;
  return {v.formulation == cases::Formulation::small_strain ? 1 : 7, marker};
}

/// A method's points: those of the tightest tolerance, which a line joins through the resolutions, and the
/// others.
struct Series {
  std::string method;
  Appearance appearance;
  std::optional<double> floor; ///< percent; springs
  std::vector<Point> tight, loose;
};

std::vector<Series> series_of(const Sweep& sweep, const Picture& picture) {
  std::vector<Series> all;
  int n_designs = 0;
  for (const std::string& method : methods_of(sweep)) {
    std::vector<const SweepRow*> rows;
    double tightest = 1;
    for (const SweepRow& row : sweep.rows) {
      if (method_name(row.variant) != method) continue;
      rows.push_back(&row);
      tightest = std::min(tightest, row.variant.tolerance);
    }
    const Variant& first = rows.front()->variant;
    Series series{method, appearance(first, n_designs), std::nullopt, {}, {}};
    if (first.program == Program::springs) {
      ++n_designs;
      series.floor = errors_by_level(sweep, method, picture.error).back();
    }
    for (const SweepRow* row : rows) {
      const auto seconds = median_seconds(*row, picture.clock), error = error_of(*row, picture.error);
      if (!seconds || !error || !(*error > 0)) continue; // zero has no place on a logarithmic axis
      (row->variant.tolerance == tightest ? series.tight : series.loose)
          .push_back({full_name(row->variant), family_of(row->variant), *seconds, *error});
    }
    if (!series.tight.empty() || !series.loose.empty()) all.push_back(series);
  }
  return all;
}

/// Blocks of the data file: two per method, tight and loose, then the Pareto front. An empty one has a point
/// that is not drawn, so that the numbers stay.
void write_data(std::ostream& out, const std::vector<Series>& all, const std::vector<Point>& points) {
  CsvWriter csv(out, 6);
  const auto block = [&](const std::string& title, const std::vector<Point>& content) {
    csv.row("# " + title + ": ms", "percent", "variant");
    for (const Point& p : content) csv.row(1e3 * p.seconds, p.error_percent, p.name);
    if (content.empty()) csv.row("nan", "nan", "none");
    csv.end_block();
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

PlotValues values_of(const Sweep& sweep, const Picture& picture, const std::vector<Series>& all) {
  std::vector<std::string> methods;
  std::vector<double> linetypes, markers, floors;
  double least = std::numeric_limits<double>::infinity(); // error that is drawn
  for (const Series& series : all) {
    methods.push_back(series.tight.empty() ? "" : series.method); // what has no line has no title
    linetypes.push_back(series.appearance.linetype);
    markers.push_back(series.appearance.marker);
    floors.push_back(series.floor.value_or(0));
    for (const auto* points : {&series.tight, &series.loose})
      for (const Point& p : *points) least = std::min(least, p.error_percent);
  }
  const double uncertainty = uncertainty_percent(*sweep.reference, picture.error);
  // A much smaller uncertainty would leave no room for the errors.
  const double bottom = 0.7 * std::clamp(uncertainty, least / 10, least);
  return {{"headline", sweep.definition.name + ": " + picture.title},
          {"methods", methods},
          {"linetypes", linetypes},
          {"markers", markers},
          {"floors", floors},
          {"uncertainty", uncertainty},
          {"bottom", bottom},
          {"width", 1200.},
          {"height", 700.}};
}

} // namespace

std::vector<std::string> plot_sweep(const std::string& folder, const Sweep& sweep) {
  std::vector<std::string> drawn;
  if (!sweep.reference) return drawn;
  for (const Picture& picture : pictures) {
    const std::vector<Series> all = series_of(sweep, picture);
    if (all.empty()) continue; // such as a case without measures
    write_file(folder + "/" + picture.name + ".csv", [&](std::ostream& out) {
      write_data(out, all, points_of(sweep, picture.error, picture.clock));
    });
    draw(folder, picture.name, "sweep", values_of(sweep, picture, all));
    drawn.emplace_back(picture.name);
  }
  return drawn;
}

} // namespace springproof::compare
