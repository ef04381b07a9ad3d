#include "compare/interact/replay.hpp"

#include "mechanics/surface/embedded_surface.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

const std::string recording_header = "step,time,x,y,z,fx,fy,fz";
constexpr std::size_t most_rows = 200'000;

struct PullRow {
  long step;
  Vector3d place, force; ///< mm, N
};

/// A place that was held, from its first step on, one force (N) a step.
struct Hold {
  Vector3d place;
  long first_step;
  std::vector<Vector3d> force;
};

std::vector<double> eight_numbers(const std::string& line) {
  constexpr double largest = 1e9;
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    double value = 0;
    const auto [stop, error] = std::from_chars(line.data() + begin, line.data() + end, value);
    if (error != std::errc() || stop != line.data() + end || !(std::abs(value) <= largest)) return {};
    numbers.push_back(value);
    begin = end + 1;
  }
  return numbers.size() == 8 ? numbers : std::vector<double>{};
}

std::vector<PullRow> rows_of(const std::string& text, const std::string& path, double step) {
  std::istringstream stream(text);
  std::vector<PullRow> rows;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    const auto refuse = [&](const std::string& problem) {
      throw cases::InputError(fmt::format("{}:{}: {}", path, number, problem));
    };
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (++number == 1) {
      if (line != recording_header) refuse("must be the header " + recording_header);
      continue;
    }
    if (line.empty()) continue;
    const std::vector<double> n = eight_numbers(line);
    if (n.empty())
      refuse(fmt::format("must be eight numbers up to 1e9 between commas: {}", recording_header));
    const bool is_next =
        n[0] == std::floor(n[0]) && n[0] > (rows.empty() ? 0 : static_cast<double>(rows.back().step));
    if (!is_next) refuse("step must be a whole number above 0 and above that of the line before");
    if (!(std::abs(n[1] - n[0] * step) <= 1e-6 * n[1]))
      refuse(fmt::format("time is {:.10g} s, must be {:.10g} s at step {:.0f} of dynamics.step = {:.10g} s",
                         n[1], n[0] * step, n[0], step));
    if (rows.size() == most_rows) refuse(fmt::format("a recording may have {} steps with a pull", most_rows));
    rows.push_back({static_cast<long>(n[0]), {n[2], n[3], n[4]}, {n[5], n[6], n[7]}});
  }
  if (rows.empty()) throw cases::InputError(path + ": has no pull");
  return rows;
}

std::vector<Hold> holds_of(const std::vector<PullRow>& rows) {
  std::vector<Hold> holds;
  for (const PullRow& row : rows) {
    const bool goes_on = !holds.empty() && holds.back().place == row.place &&
                         row.step == holds.back().first_step + static_cast<long>(holds.back().force.size());
    if (!goes_on) holds.push_back({row.place, row.step, {}});
    holds.back().force.push_back(row.force);
  }
  return holds;
}

/// A component of a hold's force, N: constant in each step, with jumps just after the steps' ends, which some
/// schemes look at.
cases::History history_of(const Hold& hold, int axis, double step) {
  const auto just_after = [&](long n) { return (static_cast<double>(n) + 1e-6) * step; };
  cases::History history;
  long n = hold.first_step - 1;
  history.points.push_back({just_after(n), 0});
  for (const Vector3d& force : hold.force) {
    history.points.push_back({just_after(n), force[axis]});
    history.points.push_back({just_after(++n), force[axis]});
  }
  history.points.push_back({just_after(n), 0});
  return history;
}

} // namespace

cases::Scene with_recording(cases::Scene scene, const std::string& text, const std::string& path) {
  const auto& dynamics = scene.definition.dynamics;
  if (!dynamics) throw cases::InputError(scene.definition.file + ": has no [dynamics] to replay pulls in");
  const std::vector<PullRow> rows = rows_of(text, path, dynamics->step);
  if (const double last = static_cast<double>(rows.back().step) * dynamics->step;
      last > dynamics->end * (1 + 1e-9))
    throw cases::InputError(fmt::format(
        "{}: ends at {:.10g} s: dynamics.end is {:.10g} s, must not be before", path, last, dynamics->end));
  const std::vector<Hold> holds = holds_of(rows);
  cases::TriangleMesh places;
  for (const Hold& hold : holds) places.vertices.push_back(hold.place);
  const mechanics::EmbeddedSurface embedded = mechanics::embed(std::move(places), scene.mesh);
  for (std::size_t h = 0; h < holds.size(); ++h)
    for (int axis = 0; axis < 3; ++axis) {
      const cases::History history = history_of(holds[h], axis, dynamics->step);
      for (std::size_t v = 0; v < 8; ++v) {
        cases::Scene::AppliedLoad applied;
        applied.selection.nodes = {embedded.vertices[h].nodes[v]};
        applied.load.kind = cases::LoadKind::nodal_force;
        applied.load.value = embedded.vertices[h].weights[v] * Vector3d::Unit(axis); // times the factor, N
        applied.load.history = history;
        scene.loads.push_back(std::move(applied));
      }
    }
  return scene;
}

} // namespace springproof::compare
