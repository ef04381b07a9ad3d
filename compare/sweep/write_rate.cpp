#include "compare/sweep/at_rate.hpp"

#include "cases/case/names.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

std::vector<Point> points_at(const Sweep& sweep) {
  return points_of(sweep, Error::field, Clock::first_answer);
}

/// "errs by 14 %", with what is behind a small error.
std::string error_of(const Point& point, double uncertainty_percent) {
  if (point.error_percent <= uncertainty_percent)
    return fmt::format("errs by less than the reference's uncertainty of {:.2g} %", uncertainty_percent);
  const std::string error = fmt::format("errs by {:.2g} %", point.error_percent);
  if (!point.more_cells_percent) return error;
  return error +
         fmt::format(" by accident (its springs in equilibrium by {:.2g} %)", *point.more_cells_percent);
}

/// The neighbour on the front that is the next more accurate one, otherwise the next faster one.
std::optional<Point> next_to(const Point& best, const std::vector<Point>& points) {
  const std::vector<Point> front = pareto_front(points);
  const auto at =
      std::find_if(front.begin(), front.end(), [&](const Point& p) { return p.name == best.name; });
  if (at == front.end()) return std::nullopt;
  if (at + 1 != front.end()) return *(at + 1);
  return at == front.begin() ? std::nullopt : std::optional(*(at - 1));
}

} // namespace

std::string rate_sentence(const Sweep& sweep) {
  const double frame = 1 / sweep.rate->hertz;
  const std::string start = fmt::format("at {:g} Hz on this machine ({}, one thread): ", sweep.rate->hertz,
                                        one_line(describe_machine().processor));
  if (!sweep.reference)
    return start + "nothing can be told without a reference: " + sweep.reason_without_reference;
  const std::vector<Point> points = points_at(sweep);
  if (points.empty()) return start + "nothing that was tried answers";
  const double uncertainty = uncertainty_percent(*sweep.reference, Error::field);
  const auto describe = [&](const Point& point) {
    return fmt::format("{}, which {} at {} a frame", point.name, error_of(point, uncertainty),
                       time_text(point.seconds));
  };
  const auto found = most_accurate_within(points, frame);
  if (!found) {
    const auto& fastest = *std::min_element(
        points.begin(), points.end(), [](const Point& a, const Point& b) { return a.seconds < b.seconds; });
    return start + fmt::format("nothing that was tried keeps up; the fastest is {}", describe(fastest));
  }
  const Point& best = points[*found];
  std::string sentence = start + "use " + describe(best);
  if (const auto next = next_to(best, points))
    sentence +=
        fmt::format("; next best is {}{}", describe(*next), next->seconds > frame ? ", too long" : "");
  return sentence;
}

Json rate_row_to_json(const Sweep& sweep, const SweepRow& row) {
  const Variant& variant = row.variant;
  const auto& steps = variant.real_time;
  const auto seconds = median(row.run.first_seconds);
  Json errors{{"field", row.field_error_percent}};
  for (std::size_t m = 0; m < row.measure_error_percent.size(); ++m)
    errors[sweep.definition.measures[m].name] = row.measure_error_percent[m];
  const bool are_springs = variant.program == Program::springs;
  Json json{{"design", are_springs ? Json(cases::name_of(variant.design)) : Json(nullptr)},
            {"element", are_springs ? Json(nullptr) : Json(cases::name_of(variant.element))},
            {"cells", variant.cells[0] > 0 ? Json(variant.cells) : Json(nullptr)},
            {"method", steps ? Json(name_of(method_of(*steps))) : Json(nullptr)},
            {"iterations", nullptr},
            {"substeps", nullptr},
            {"status", cases::name_of(row.run.first.status)},
            {"message", row.run.first.message},
            {"milliseconds_a_frame", nullptr},
            {"timings", row.run.first_seconds.size()},
            {"keeps_up", nullptr},
            {"error_percent", errors},
            {"in_equilibrium_percent", row.in_equilibrium_percent}};
  if (steps) {
    const Json settings = settings_of(*steps, sweep.definition);
    for (const char* key : {"iterations", "substeps"}) json[key] = settings.value(key, Json(nullptr));
  }
  if (seconds) {
    json["milliseconds_a_frame"] = 1e3 * *seconds;
    json["keeps_up"] = *seconds <= 1 / sweep.rate->hertz;
  }
  return json;
}

Json row_of_text(const Sweep& sweep, const SweepRow& row) {
  Json json = rate_row_to_json(sweep, row);
  json["model"] = model_name(row.variant);
  if (row.variant.cells[0] > 0) json["cells"] = cells_name(row.variant.cells);
  return json;
}

Columns rate_columns(const cases::Case& definition) {
  Columns columns =
      columns_of("case design element cells_x=cells.0 cells_y=cells.1 cells_z=cells.2 method iterations "
                 "substeps status message milliseconds_a_frame keeps_up "
                 "field_error_percent=error_percent.field in_equilibrium_percent");
  for (const cases::Measure& measure : definition.measures)
    columns.push_back({measure.name + "_error_percent", "error_percent." + measure.name});
  return columns;
}

Columns rate_columns_of_text(const cases::Case& definition) {
  Columns columns =
      columns_of("model cells{:<} method{:<} it.=iterations substeps "
                 "ms~a~frame=milliseconds_a_frame{:.3g} n=timings keeps~up=keeps_up "
                 "field~%=error_percent.field{:.3g} in~equilibrium~%=in_equilibrium_percent{:.3g}");
  for (const cases::Measure& measure : definition.measures)
    columns.push_back({measure.name + " %", "error_percent." + measure.name, "{:+.3g}"});
  return columns;
}

void write_rate_screen(std::ostream& out, const Sweep& sweep) {
  if (!sweep.reference) return write_paragraph(out, rate_sentence(sweep), "", "  ");
  const ReferenceValue& reference = sweep.reference->field;
  write_paragraph(
      out,
      "reference: " + (reference.note.empty() ? "the finite elements' limit" : reference.note) +
          (reference.uncertainty_percent > 0
               ? fmt::format("; known to {:.2g} % (displacement field)", reference.uncertainty_percent)
               : ""),
      "", "  ");
  out << '\n';
  write_paragraph(out, rate_sentence(sweep), "", "  ");
  const std::vector<Point> front = pareto_front(points_at(sweep));
  if (front.empty()) return;
  out << "\nError of the displacement field against the time of a frame: nothing that was tried is both\n"
         "faster and more accurate than\n";
  Json rows = Json::array();
  for (const Point& point : front)
    for (const SweepRow& row : sweep.rows)
      if (full_name(row.variant) == point.name) rows.push_back(row_of_text(sweep, row));
  write_table(
      out,
      columns_of("ms~a~frame=milliseconds_a_frame{:.3g} keeps~up=keeps_up error~%=error_percent.field{:.3g} "
                 "model{:<} cells{:<} method{:<} it.=iterations substeps"),
      rows);
  write_paragraph(out,
                  fmt::format("a frame's time is the median of {}; here, the median of {} such medians",
                              n_timed_frames - 1, n_timings),
                  "  ", "  ");
  out << '\n';
}

} // namespace springproof::compare
