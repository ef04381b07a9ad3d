#include "compare/sweep/motion_conclusions.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

namespace springproof::compare {

namespace {

/// Of the method's finest mesh and shortest step that has one.
std::optional<double> error_in_the_end(const MotionSweep& sweep, const std::string& method) {
  const MotionRow* finest = nullptr;
  const auto fineness = [](const MotionRow& row) { return std::tuple(row.cells[0], -row.step); };
  for (const MotionRow& row : sweep.rows)
    if (row.method == method && row.error_percent && (!finest || fineness(*finest) < fineness(row)))
      finest = &row;
  return finest ? finest->error_percent : std::nullopt;
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

std::optional<Point> point_of(const MotionSweep& sweep, const MotionRow& row) {
  if (!(row.error_percent >= 0.)) return std::nullopt;
  Point point{
      fmt::format("{}, {} cells, steps of {:g} ms", row.method, cells_name(row.cells), 1e3 * row.step),
      row.family(), row.seconds_per_second, *row.error_percent};
  const auto in_the_end = error_in_the_end(sweep, row.method);
  if (in_the_end && is_accidental(point.error_percent, *in_the_end) &&
      *in_the_end - point.error_percent > sweep.uncertainty_percent)
    point.more_cells_percent = in_the_end;
  return point;
}

std::vector<Point> points_of(const MotionSweep& sweep) {
  std::vector<Point> points;
  for (const MotionRow& row : sweep.rows)
    if (const auto point = point_of(sweep, row)) points.push_back(*point);
  return points;
}

std::string interactive_sentence(const MotionSweep& sweep, double hertz) {
  std::vector<Point> points, converging; // those that keep up, and of them those without an accident
  for (const MotionRow& row : sweep.rows) {
    const auto point = point_of(sweep, row);
    if (!point || !(row.step <= (1 + 1e-9) / hertz) || !(point->seconds <= 1)) continue;
    points.push_back(*point);
    if (!point->more_cells_percent) converging.push_back(*point);
  }
  const auto found = most_accurate_within(points, 1);
  if (!found) return fmt::format("at {:g} Hz: none of these motions keeps up", hertz);
  const Point& best = points[*found];
  const double uncertainty = sweep.uncertainty_percent;
  std::string sentence = fmt::format("at {:g} Hz: {} are the most accurate that keep up: {}", hertz,
                                     best.name, describe(best, uncertainty));
  const auto add = [&](const std::string& what, const Point& point) {
    sentence += fmt::format("; {}: {}: {}", what, point.name, describe(point, uncertainty));
  };
  if (const auto without = most_accurate_within(converging, 1); best.more_cells_percent && without)
    add("the most accurate not by accident", converging[*without]);
  const Family other = best.family == Family::springs ? Family::finite_elements : Family::springs;
  const auto found_other = most_accurate_within(points, 1, other);
  if (!found_other) return sentence + fmt::format("; no {} keep up", family_name(other));
  const Point& rival = points[*found_other];
  add(fmt::format("the most accurate {}", family_name(other)), rival);
  if (rival.error_percent > uncertainty && rival.error_percent - best.error_percent <= uncertainty)
    sentence += fmt::format(", which the reference's uncertainty of {:.2g} % does not tell from the best",
                            uncertainty);
  return sentence;
}

std::vector<std::string> conclusions(const MotionSweep& sweep) {
  std::vector<std::string> sentences;
  for (const double hertz : {30., 60., 500.}) sentences.push_back(interactive_sentence(sweep, hertz));
  return sentences;
}

} // namespace springproof::compare
