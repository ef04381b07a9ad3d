#include "compare/sweep/write_sweep.hpp"

#include "compare/measure/box_plot.hpp"
#include "compare/study/study.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace springproof::compare {

namespace {

/// The best of the points that are allowed, by a key that is to be small.
template<class IsAllowed, class Key>
std::optional<std::size_t> best(const std::vector<Point>& points, const IsAllowed& is_allowed,
                                const Key& key) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (is_allowed(points[i]) && (!found || key(points[i]) < key(points[*found]))) found = i;
  return found;
}

bool any_point(const Point&) {
  return true;
}

std::tuple<double, double> speed_first(const Point& p) {
  return {p.seconds, p.error_percent};
}

std::string describe(const Point& p) {
  const std::string error = p.more_cells_percent
                                ? fmt::format("{:.2g} % by accident, more cells lead to {:.2g} %",
                                              p.error_percent, *p.more_cells_percent)
                                : fmt::format("{:.2g} %", p.error_percent);
  return fmt::format("{} ({}, {})", p.name, time_text(p.seconds), error);
}

constexpr const char* without_points = "no model was measured.";

std::vector<std::string> speed_sentences(const Sweep& sweep, Error error, Clock clock) {
  const std::vector<Point> points = points_of(sweep, error, clock);
  const double uncertainty = uncertainty_percent(*sweep.reference, error);
  std::vector<std::string> sentences;
  for (const double percent : {10., 5., 1.})
    sentences.push_back(fastest_sentence(points, percent, uncertainty));
  for (const double seconds : {1e-3, 16e-3, 100e-3})
    sentences.push_back(most_accurate_sentence(points, seconds, uncertainty));
  return sentences;
}

std::vector<std::string> floor_sentences(const Sweep& sweep, Error error) {
  std::vector<std::string> levels, sentences;
  for (const auto& cells : sweep.plan.levels) levels.push_back(cells_name(cells));
  for (const std::string& method : methods_of(sweep))
    if (method.rfind("springs ", 0) == 0)
      sentences.push_back(floor_sentence(method, levels, errors_by_level(sweep, method, error)));
  return sentences;
}

/// Median of the repetitions; nothing without any.
std::optional<double> median_seconds(const SweepRow& row, Clock clock) {
  if (clock == Clock::re_solve) return median(row.run.again_seconds);
  const auto first = median(row.run.first_seconds);
  if (!first) return std::nullopt;
  return *first + median(row.run.setup_seconds).value_or(0); // CalculiX does not tell them apart
}

std::optional<double> error_of(const SweepRow& row, Error error) {
  return error == Error::field ? row.field_error_percent : worst_measure_error(row);
}

/// The error of the method's finest mesh and shortest step that has one.
std::optional<double> error_in_the_end(const Sweep& sweep, const std::string& method) {
  const SweepRow* finest = nullptr;
  const auto fineness = [](const SweepRow& row) {
    return std::tuple(row.variant.cells[0], -row.variant.step);
  };
  for (const SweepRow& row : sweep.rows)
    if (method_name(row.variant) == method && row.field_error_percent &&
        (!finest || fineness(*finest) < fineness(row)))
      finest = &row;
  return finest ? finest->field_error_percent : std::nullopt;
}

std::string describe(const Point& point, double uncertainty_percent) {
  std::string error = point.error_percent > uncertainty_percent
                          ? fmt::format("{:.2g} %", point.error_percent)
                          : fmt::format("below the reference's uncertainty of {:.2g} %", uncertainty_percent);
  if (point.more_cells_percent)
    error += fmt::format(" by accident (more cells and shorter steps lead to {:.2g} %)",
                         *point.more_cells_percent);
  return fmt::format("error {}, {:.2g} s of computing a second", error, point.seconds);
}

} // namespace

Family other(Family family) {
  return family == Family::springs ? Family::finite_elements : Family::springs;
}

std::vector<Point> pareto_front(const std::vector<Point>& points) {
  std::vector<Point> order = points, front;
  std::stable_sort(order.begin(), order.end(),
                   [](const Point& a, const Point& b) { return speed_first(a) < speed_first(b); });
  for (const Point& point : order)
    if (front.empty() || point.error_percent < front.back().error_percent) front.push_back(point);
  return front;
}

std::vector<Point> thinned_front(const std::vector<Point>& points, std::size_t n) {
  const std::vector<Point> front = pareto_front(points);
  std::vector<Point> thinned;
  const std::size_t n_kept = std::min(n, front.size());
  for (std::size_t i = 0; i < n_kept; ++i)
    thinned.push_back(front[n_kept == 1 ? 0 : i * (front.size() - 1) / (n_kept - 1)]);
  return thinned;
}

std::optional<std::size_t> fastest_within(const std::vector<Point>& points, double error_percent,
                                          std::optional<Family> family) {
  const auto is_allowed = [&](const Point& p) {
    return p.error_percent <= error_percent && (!family || p.family == *family);
  };
  return best(points, is_allowed, speed_first);
}

std::optional<std::size_t> most_accurate_within(const std::vector<Point>& points, double seconds,
                                                std::optional<Family> family) {
  return best(
      points, [&](const Point& p) { return p.seconds <= seconds && (!family || p.family == *family); },
      [](const Point& p) { return std::tuple(p.error_percent, p.seconds); });
}

bool is_accidental(double error, double with_most_cells) {
  return error < (1 - floor_fraction) * with_most_cells;
}

std::optional<std::size_t> first_level_at_floor(const std::vector<std::optional<double>>& errors) {
  if (errors.empty() || !errors.back()) return std::nullopt;
  const double floor = *errors.back();
  std::size_t level = errors.size() - 1;
  while (level > 0 && errors[level - 1] && std::abs(*errors[level - 1] - floor) <= floor_fraction * floor)
    --level;
  return level;
}

std::optional<double> worst_measure_error(const SweepRow& row) {
  WorstError errors;
  for (const auto& error : row.measure_error_percent)
    if (error) errors.add(*error);
  return errors.worst;
}

std::optional<Point> point_of(const Sweep& sweep, const SweepRow& row, Error error, Clock clock) {
  const auto seconds = median_seconds(row, clock), percent = error_of(row, error);
  if (!seconds || !percent || !(*percent >= 0)) return std::nullopt;
  Point point{full_name(row.variant), family_of(row.variant), *seconds, *percent, {}, row.variant.step};
  const std::string method = method_name(row.variant);
  const bool moves = sweep.definition.dynamics.has_value();
  const auto in_the_end = sweep.rate ? row.in_equilibrium_percent
                          : moves    ? error_in_the_end(sweep, method)
                                     : errors_by_level(sweep, method, error).back();
  const double told =
      moves && !sweep.rate ? uncertainty_percent(*sweep.reference, error) : 0; // the difference's
  if (in_the_end && is_accidental(*percent, *in_the_end) && *in_the_end - *percent > told)
    point.more_cells_percent = in_the_end;
  return point;
}

std::vector<Point> points_of(const Sweep& sweep, Error error, Clock clock) {
  std::vector<Point> points;
  for (const SweepRow& row : sweep.rows)
    if (auto point = point_of(sweep, row, error, clock)) points.push_back(std::move(*point));
  return points;
}

std::vector<std::optional<double>> errors_by_level(const Sweep& sweep, const std::string& method,
                                                   Error error) {
  std::vector<std::optional<double>> errors;
  for (const auto& cells : sweep.plan.levels) {
    const SweepRow* tightest = nullptr;
    for (const SweepRow& row : sweep.rows)
      if (method_name(row.variant) == method && row.variant.cells == cells &&
          (!tightest || row.variant.tolerance < tightest->variant.tolerance))
        tightest = &row;
    errors.push_back(tightest ? error_of(*tightest, error) : std::nullopt);
  }
  return errors;
}

double uncertainty_percent(const Reference& reference, Error error) {
  if (error == Error::field) return reference.field.uncertainty_percent;
  double largest = 0;
  for (const ReferenceValue& value : reference.measures)
    largest = std::max(largest, value.uncertainty_percent);
  return largest;
}

std::vector<std::string> methods_of(const Sweep& sweep) {
  std::vector<std::string> methods;
  for (const SweepRow& row : sweep.rows) {
    const std::string method = method_name(row.variant);
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
  }
  return methods;
}

const char* what(Error error) {
  return error == Error::field ? "displacement field" : "worst measure";
}

const char* what(Clock clock) {
  return clock == Clock::first_answer ? "first answer (setup and solve from rest)"
                                      : "re-solve after a load change of 5 %";
}

const char* family_name(Family family) {
  return family == Family::springs ? "springs" : "finite elements";
}

std::string short_number(double value) {
  return value < 99.5 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

std::string time_text(double seconds) {
  return seconds < 0.9995 ? fmt::format("{:.3g} ms", 1e3 * seconds) : fmt::format("{:.3g} s", seconds);
}

std::string fastest_sentence(const std::vector<Point>& points, double error_percent,
                             double uncertainty_percent) {
  const std::string start = fmt::format("within {:g} %: ", error_percent);
  if (points.empty()) return start + without_points;
  if (!(uncertainty_percent < error_percent))
    return start + fmt::format("not to be told, for the reference is itself uncertain by {:.2g} %.",
                               uncertainty_percent);
  const auto fastest = fastest_within(points, error_percent);
  if (!fastest)
    return start + "no model gets there; nearest comes " +
           describe(points[*best(points, any_point, [](const Point& p) { return p.error_percent; })]) + ".";
  const Point& winner = points[*fastest];
  const Family others = other(winner.family);
  const auto rival = fastest_within(points, error_percent, others);
  const std::string sentence = start + describe(winner) + " is the fastest";
  if (!rival) return sentence + fmt::format("; no {} get there.", family_name(others));
  return sentence + fmt::format(", {} times as fast as the fastest {}, {}.",
                                short_number(points[*rival].seconds / winner.seconds), family_name(others),
                                describe(points[*rival]));
}

std::string most_accurate_sentence(const std::vector<Point>& points, double seconds,
                                   double uncertainty_percent) {
  const std::string start = fmt::format("in {}: ", time_text(seconds));
  if (points.empty()) return start + without_points;
  const auto found = most_accurate_within(points, seconds);
  if (!found)
    return start + "no model answers in that time; the fastest is " +
           describe(points[*best(points, any_point, [](const Point& p) { return p.seconds; })]) + ".";
  const std::string sentence = start + describe(points[*found]) + " is the most accurate";
  if (points[*found].error_percent > uncertainty_percent) return sentence + ".";
  return sentence +
         fmt::format(", as far as the reference's uncertainty of {:.2g} % can tell.", uncertainty_percent);
}

std::string floor_sentence(const std::string& design, const std::vector<std::string>& levels,
                           const std::vector<std::optional<double>>& errors) {
  const auto level = first_level_at_floor(errors);
  if (!level) return design + ": no error on the finest level, so no floor is known.";
  const double floor = *errors.back();
  std::size_t least_level = errors.size() - 1;
  for (std::size_t l = 0; l < errors.size(); ++l)
    if (errors[l] && *errors[l] < *errors[least_level]) least_level = l;
  std::string sentence;
  if (*level + 1 == errors.size())
    sentence = fmt::format("{}: no floor in sight: the error still changes up to {}, where it is {:.2g} %",
                           design, levels.back(), floor);
  else
    sentence =
        fmt::format("{}: more cells than {} do not help: from there on the error stays within {:g} % of its "
                    "floor, {:.2g} %",
                    design, levels[*level], 100 * floor_fraction, floor);
  if (is_accidental(*errors[least_level], floor))
    sentence += fmt::format(" (the least, {:.2g} %, is that of {}, where errors of mesh and model cancel)",
                            *errors[least_level], levels[least_level]);
  return sentence + ".";
}

std::vector<Conclusions> conclusions(const Sweep& sweep) {
  static_assert(load_change == 0.05, "a heading here says so");
  if (!sweep.reference)
    return {{"nothing can be concluded without a reference", {sweep.reason_without_reference}}};
  std::vector<Conclusions> all;
  for (const Error error : {Error::field, Error::worst_measure}) {
    if (error == Error::worst_measure && sweep.reference->measures.empty()) continue;
    for (const Clock clock : {Clock::first_answer, Clock::re_solve})
      all.push_back({std::string(what(error)) + ", " + what(clock), speed_sentences(sweep, error, clock)});
    all.push_back({std::string(what(error)) + ", more cells", floor_sentences(sweep, error)});
  }
  return all;
}

std::string interactive_sentence(const Sweep& sweep, double hertz) {
  std::vector<Point> points, converging; // those that keep up, and of them those without an accident
  for (const Point& point : points_of(sweep, Error::field, Clock::first_answer)) {
    if (!(point.step <= (1 + 1e-9) / hertz) || !(point.seconds <= 1)) continue;
    points.push_back(point);
    if (!point.more_cells_percent) converging.push_back(point);
  }
  const auto found = most_accurate_within(points, 1);
  if (!found) return fmt::format("at {:g} Hz: none of these motions keeps up", hertz);
  const Point& best = points[*found];
  const double uncertainty = uncertainty_percent(*sweep.reference, Error::field);
  std::string sentence = fmt::format("at {:g} Hz: {} are the most accurate that keep up: {}", hertz,
                                     best.name, describe(best, uncertainty));
  const auto add = [&](const std::string& what, const Point& point) {
    sentence += fmt::format("; {}: {}: {}", what, point.name, describe(point, uncertainty));
  };
  if (const auto without = most_accurate_within(converging, 1); best.more_cells_percent && without)
    add("the most accurate not by accident", converging[*without]);
  const Family others = other(best.family);
  const auto found_other = most_accurate_within(points, 1, others);
  if (!found_other) return sentence + fmt::format("; no {} keep up", family_name(others));
  const Point& rival = points[*found_other];
  add(fmt::format("the most accurate {}", family_name(others)), rival);
  if (rival.error_percent > uncertainty && rival.error_percent - best.error_percent <= uncertainty)
    sentence += fmt::format(", which the reference's uncertainty of {:.2g} % does not tell from the best",
                            uncertainty);
  return sentence;
}

std::vector<std::string> interactive_sentences(const Sweep& sweep) {
  std::vector<std::string> sentences;
  for (const double hertz : {30., 60., 500.}) sentences.push_back(interactive_sentence(sweep, hertz));
  return sentences;
}

} // namespace springproof::compare
