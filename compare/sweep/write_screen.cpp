#include "compare/sweep/at_rate.hpp"

#include "compare/provenance/print.hpp"

#include <algorithm>
#include <array>

namespace springproof::compare {

namespace {

constexpr std::array<double, 3> told_errors{10, 5, 1}; ///< percent
constexpr std::array<double, 2> told_rates{500, 60};   ///< Hz: touch, a screen
constexpr std::size_t label_columns = 8;
constexpr std::array<std::size_t, 2> side_columns{43, screen_width - label_columns - 43};
constexpr std::size_t front_columns = screen_width / 2 - 2;
constexpr std::size_t n_told_points = 6;       ///< points of a front
constexpr std::size_t n_told_failures = 2;     ///< failed models; the files have all
constexpr std::size_t reason_characters = 180; ///< which two lines hold
constexpr std::size_t characters_of_title = 180;

std::string short_time(double seconds) {
  return seconds < 0.9995 ? short_number(1e3 * seconds) + " ms" : short_number(seconds) + " s";
}

/// Name without the family, whose column it stands in, and the tolerance, which the files have. Its cells
/// stay where its method has to be cut.
std::string short_name(const Point& point, std::size_t width) {
  const std::string family = "springs ";
  std::string name = point.name.substr(0, point.name.find(" to "));
  if (name.rfind(family, 0) == 0) name = name.substr(family.size());
  const std::size_t blank = name.rfind(' ');
  const std::string cells = blank == std::string::npos ? "" : name.substr(blank);
  return in_short(name.substr(0, blank), width - std::min(width, cells.size())) + cells;
}

/// A start, the name in what the start and the end leave of a width, the end.
std::string with_name(const std::string& start, const Point& point, const std::string& end,
                      std::size_t width) {
  const std::string marked = (point.more_cells_percent ? " ~" : "") + end;
  return start + short_name(point, width - start.size() - marked.size()) + marked;
}

std::size_t width_of(Family family) {
  return side_columns[family == Family::springs ? 0 : 1] - 1;
}

/// A line of what stands below "springs" and below "finite elements".
void write_two(std::ostream& out, const std::string& label, const std::array<std::string, 2>& of_families) {
  const std::string line =
      fmt::format("{:<{}}{:<{}}{}", label, label_columns, of_families[0], side_columns[0], of_families[1]);
  out << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
}

/// ">" before the faster, with its factor; "~" where the error is small by accident.
std::string fastest_text(const std::vector<Point>& points, double percent, Family family) {
  const auto own = fastest_within(points, percent, family),
             rival = fastest_within(points, percent, other(family));
  if (!own) return "          none";
  const Point& point = points[*own];
  const bool wins = !rival || point.seconds <= points[*rival].seconds;
  const std::string factor =
      wins && rival ? fmt::format(" ({} x)", short_number(points[*rival].seconds / point.seconds)) : "";
  return with_name(fmt::format("{}{:>8} ", wins ? ">" : " ", short_time(point.seconds)), point, factor,
                   width_of(family));
}

void write_fastest(std::ostream& out, const Sweep& sweep, Error error, Clock clock) {
  const std::vector<Point> points = points_of(sweep, error, clock);
  const double uncertainty = uncertainty_percent(*sweep.reference, error);
  for (const double percent : told_errors) {
    const std::string label = fmt::format("  {:g} %", percent);
    if (!(uncertainty < percent)) {
      print(out, "{:<{}} not to be told: the reference is itself uncertain by {:.2g} %\n", label,
            label_columns, uncertainty);
      continue;
    }
    write_two(out, label,
              {fastest_text(points, percent, Family::springs),
               fastest_text(points, percent, Family::finite_elements)});
  }
}

/// An error that the reference does not know better than that is told as below its uncertainty.
std::string error_text(const Point& point, double uncertainty) {
  return point.error_percent > uncertainty ? short_number(point.error_percent) + " %"
                                           : "<" + short_number(uncertainty) + " %";
}

std::string real_time_text(const std::vector<Point>& points, double uncertainty, double hertz,
                           Family family) {
  const auto found = most_accurate_within(points, 1 / hertz, family);
  if (!found) return "          none";
  const Point& point = points[*found];
  return with_name(fmt::format(" {} at {}: ", error_text(point, uncertainty), short_time(point.seconds)),
                   point, "", width_of(family));
}

void write_real_time(std::ostream& out, const Sweep& sweep) {
  const std::vector<Point> points = points_of(sweep, Error::field, Clock::re_solve);
  const double uncertainty = uncertainty_percent(*sweep.reference, Error::field);
  out << "the most accurate that keep a rate: error at the time of a step, which is a re-solve\n";
  for (const double hertz : told_rates)
    write_two(out, fmt::format("  {:g} Hz", hertz),
              {real_time_text(points, uncertainty, hertz, Family::springs),
               real_time_text(points, uncertainty, hertz, Family::finite_elements)});
}

std::string point_text(const std::vector<Point>& front, double uncertainty, std::size_t p) {
  if (p >= front.size()) return "";
  return with_name(
      fmt::format("{:>8} {:>8} ", short_time(front[p].seconds), error_text(front[p], uncertainty)), front[p],
      "", front_columns - 1);
}

void write_fronts(std::ostream& out, const Sweep& sweep) {
  const auto front_of = [&](Clock clock) {
    return thinned_front(points_of(sweep, Error::field, clock), n_told_points);
  };
  const double uncertainty = uncertainty_percent(*sweep.reference, Error::field);
  const auto first = front_of(Clock::first_answer), again = front_of(Clock::re_solve);
  const auto line = [&](const std::string& left, const std::string& right) {
    const std::string both = fmt::format("  {:<{}}{}", left, front_columns, right);
    out << both.substr(0, both.find_last_not_of(' ') + 1) << '\n';
  };
  out << "\nSpeed against error of the displacement field: no model is both faster and more accurate than\n";
  line("in a first answer", "in a re-solve");
  for (std::size_t p = 0; p < std::max(first.size(), again.size()); ++p)
    line(point_text(first, uncertainty, p), point_text(again, uncertainty, p));
}

/// The answers, which need a reference.
void write_answers(std::ostream& out, const Sweep& sweep) {
  out << '\n';
  write_two(out, "Fastest", {" springs", " finite elements"});
  for (const Error error : {Error::field, Error::worst_measure}) {
    if (error == Error::worst_measure && sweep.reference->measures.empty()) continue;
    for (const Clock clock : {Clock::first_answer, Clock::re_solve}) {
      print(out, "{}, {}: within\n", what(error), what(clock));
      write_fastest(out, sweep, error, clock);
    }
    if (error == Error::field) write_real_time(out, sweep);
  }
  write_fronts(out, sweep);
  out << "  > (n x) the faster, and by what factor   ~ by accident: more cells lead to a larger error\n";
}

void write_truth(std::ostream& out, const Sweep& sweep) {
  if (!sweep.reference)
    return write_paragraph(out,
                           "nothing can be concluded without a reference: " + sweep.reason_without_reference);
  const Variant& finest = sweep.plan.reference.back();
  std::string text =
      fmt::format("reference: {} on up to {} cells, extrapolated; known to {:.2g} % (displacement field)",
                  method_name(finest), cells_name(finest.cells), sweep.reference->field.uncertainty_percent);
  if (!sweep.reference->measures.empty())
    text += fmt::format(", {:.2g} % (worst measure)",
                        uncertainty_percent(*sweep.reference, Error::worst_measure));
  write_paragraph(out, text, "", "  ");
}

/// Writes as many reasons as fit, and how many more there are.
void write_not_solved(std::ostream& out, const Sweep& sweep) {
  std::vector<std::string> reasons;
  for (const SweepRow& row : sweep.rows)
    if (row.run.first.status == cases::Status::failed)
      reasons.push_back(full_name(row.variant) + " failed: " + row.run.first.message);
  for (std::size_t r = 0; r < std::min(reasons.size(), n_told_failures); ++r)
    write_paragraph(out, in_short(one_line(reasons[r]), reason_characters), "", "  ");
  if (reasons.size() > n_told_failures) print(out, "and {} more failed\n", reasons.size() - n_told_failures);
}

void write_title(std::ostream& out, const Sweep& sweep) {
  const std::string text = one_line(sweep.definition.name + ": " + sweep.definition.description);
  write_paragraph(out, in_short(text, characters_of_title), "", "  ");
  if (!sweep.settings.empty())
    write_paragraph(out, fmt::format("with {}", fmt::join(sweep.settings, ", ")), "  ", "  ");
}

void tell_left_out(std::ostream& out, const std::vector<LeftOut>& left_out) {
  if (left_out.empty()) return;
  const LeftOut& last = left_out.back();
  const std::string text =
      fmt::format("left out: {}, such as {}: {}", left_out.size(), last.what, last.reason);
  write_paragraph(out, in_short(one_line(text), reason_characters), "", "  ");
}

void write_where(std::ostream& out, const Sweep& sweep, const std::string& folder) {
  if (sweep.rate)
    return write_paragraph(
        out,
        fmt::format("the search took {:.0f} s, its reference included; every row: {}", sweep.seconds,
                    folder.empty() ? "--out DIR" : "rate_sweep.txt, .csv, .json and a plot in " + folder));
  if (sweep.definition.dynamics)
    return write_paragraph(out, "every motion's row: " +
                                    (folder.empty()
                                         ? "--out DIR"
                                         : "motion_sweep.txt, motion_sweep.csv, motion_sweep.json and a "
                                           "plot in " +
                                               folder));
  const std::string where = folder.empty() ? "--out DIR" : "sweep.txt, .csv, .json and plots in " + folder;
  write_paragraph(
      out,
      fmt::format("the sweep took {:.0f} s: {} models, one at a time on {}; all rows, and "
                  "where more cells stop helping: {}",
                  sweep.seconds, sweep.rows.size(),
                  sweep.n_ranks == 1 ? "one thread" : fmt::format("{} ranks (springs on one)", sweep.n_ranks),
                  where));
}

void write_motions(std::ostream& out, const Sweep& sweep) {
  const ReferenceValue& reference = sweep.reference->field;
  write_paragraph(
      out, fmt::format("reference: {}; known to {:.2g} %", reference.note, reference.uncertainty_percent), "",
      "  ");
  out << "\nIn real time, on one thread:\n";
  for (const std::string& sentence : interactive_sentences(sweep))
    write_paragraph(out, sentence, "  ", "    ");
  out << "\nSpeed against error: no motion is both faster and more accurate than\n";
  print(out, "  {:>26} {:>9}\n", "s of computing a second", "error");
  for (const Point& point :
       thinned_front(points_of(sweep, Error::field, Clock::first_answer), 2 * n_told_points))
    print(out, "  {:>26} {:>9}  {}{}\n", short_number(point.seconds),
          error_text(point, reference.uncertainty_percent), in_short(point.name, screen_width - 42),
          point.more_cells_percent ? " ~" : "");
  out << "  ~ by accident: more cells and shorter steps lead to a larger error\n\n";
}

} // namespace

void write_sweep_screen(std::ostream& out, const Sweep& sweep, const std::string& folder) {
  write_title(out, sweep);
  if (sweep.rate) {
    write_rate_screen(out, sweep);
  } else if (sweep.definition.dynamics) {
    write_motions(out, sweep);
  } else {
    write_truth(out, sweep);
    if (sweep.reference) write_answers(out, sweep);
  }
  write_not_solved(out, sweep);
  tell_left_out(out, sweep.plan.left_out);
  write_where(out, sweep, folder);
}

} // namespace springproof::compare
