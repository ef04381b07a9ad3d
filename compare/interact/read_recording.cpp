#include "compare/interact/recording.hpp"

#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"

#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

constexpr std::size_t most_holds = 10'000;

struct PullRow {
  long step;
  Vector3d centre; ///< mm
  double radius;   ///< mm
  Vector3d force;  ///< N
};

std::vector<double> nine_numbers(const cases::TextRow& row) {
  constexpr double largest = 1e9;
  std::vector<double> numbers;
  for (const std::string_view field : row.fields) {
    const auto value = cases::number_in<double>(field);
    if (value && std::abs(*value) <= largest) numbers.push_back(*value);
  }
  return row.fields.size() == 9 && numbers.size() == 9 ? numbers : std::vector<double>{};
}

/// @param step  s
PullRow pull_of(const cases::TextRow& row, double step, long last) {
  const auto refuse = [&](const std::string& problem) { throw cases::InputError(row.place() + problem); };
  const std::vector<double> n = nine_numbers(row);
  if (n.empty()) refuse(fmt::format("must be nine numbers up to 1e9 between commas: {}", recording_header));
  if (!(n[0] == std::floor(n[0]) && n[0] > static_cast<double>(last)))
    refuse("step must be a whole number above 0 and above that of the line before");
  if (!(std::abs(n[1] - n[0] * step) <= 1e-6 * n[1]))
    refuse(fmt::format("time is {:.10g} s, must be {:.10g} s at step {:.0f} of dynamics.step = {:.10g} s",
                       n[1], n[0] * step, n[0], step));
  if (!(n[5] >= 0)) refuse("radius must be 0 or above (mm)");
  return {static_cast<long>(n[0]), {n[2], n[3], n[4]}, n[5], {n[6], n[7], n[8]}};
}

std::vector<PullRow> rows_of(const std::string& text, const std::string& path, double step) {
  std::vector<PullRow> rows;
  bool has_heading = false;
  const auto check_heading = [&](const cases::TextRow& row) {
    has_heading = row.line == recording_header;
    if (!has_heading) throw cases::InputError(row.place() + "must be the header " + recording_header);
  };
  cases::read_rows(text, path, cases::Between::commas, check_heading, [&](const cases::TextRow& row) {
    if (!has_heading) check_heading(row);
    if (rows.size() == most_recorded)
      throw cases::InputError(
          fmt::format("{}a recording may have {} steps with a pull", row.place(), most_recorded));
    rows.push_back(pull_of(row, step, rows.empty() ? 0 : rows.back().step));
  });
  if (rows.empty()) throw cases::InputError(path + ": has no pull");
  return rows;
}

std::vector<Hold> holds_of(const std::vector<PullRow>& rows) {
  std::vector<Hold> holds;
  for (const PullRow& row : rows) {
    const bool goes_on = !holds.empty() && holds.back().centre == row.centre &&
                         holds.back().radius == row.radius &&
                         row.step == holds.back().first_step + static_cast<long>(holds.back().force.size());
    if (!goes_on) holds.push_back({row.centre, row.radius, row.step, {}});
    holds.back().force.push_back(row.force);
  }
  return holds;
}

} // namespace

std::vector<Hold> read_recording(const std::string& text, const std::string& path, double step, double end) {
  const std::vector<PullRow> rows = rows_of(text, path, step);
  if (const double last = static_cast<double>(rows.back().step) * step; last > end * (1 + 1e-9))
    throw cases::InputError(
        fmt::format("{}: ends at {:.10g} s: dynamics.end is {:.10g} s, must not be before", path, last, end));
  std::vector<Hold> holds = holds_of(rows);
  if (holds.size() > most_holds)
    throw cases::InputError(fmt::format("{}: has {} places, may have {}", path, holds.size(), most_holds));
  return holds;
}

} // namespace springproof::compare
