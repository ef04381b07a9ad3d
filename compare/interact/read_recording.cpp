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

/// Returns the numbers of a row of so many; none if it is another row.
std::vector<double> numbers_of(const cases::TextRow& row, std::size_t n_numbers) {
  constexpr double largest = 1e9;
  std::vector<double> numbers;
  for (const std::string_view field : row.fields) {
    const auto value = cases::number_in<double>(field);
    if (value && std::abs(*value) <= largest) numbers.push_back(*value);
  }
  return row.fields.size() == n_numbers && numbers.size() == n_numbers ? numbers : std::vector<double>{};
}

/// @param step, time  of a row     @param length  of a step, s
void check_time(const cases::TextRow& row, double step, double time, double length) {
  if (!(std::abs(time - step * length) <= 1e-6 * time))
    throw cases::InputError(
        fmt::format("{}time is {:.10g} s, must be {:.10g} s at step {:.0f} of dynamics.step = {:.10g} s",
                    row.place(), time, step * length, step, length));
}

/// @param last  s, of the last row     @param end  s, of the case
void check_end(const std::string& path, double last, double end) {
  if (last > end * (1 + 1e-9))
    throw cases::InputError(
        fmt::format("{}: ends at {:.10g} s: dynamics.end is {:.10g} s, must not be before", path, last, end));
}

/// @param step  s
PullRow pull_of(const cases::TextRow& row, double step, long last) {
  const auto refuse = [&](const std::string& problem) { throw cases::InputError(row.place() + problem); };
  const std::vector<double> n = numbers_of(row, 9);
  if (n.empty()) refuse(fmt::format("must be nine numbers up to 1e9 between commas: {}", recording_header));
  if (!(n[0] == std::floor(n[0]) && n[0] > static_cast<double>(last)))
    refuse("step must be a whole number above 0 and above that of the line before");
  check_time(row, n[0], n[1], step);
  if (!(n[5] >= 0)) refuse("radius must be 0 or above (mm)");
  return {static_cast<long>(n[0]), {n[2], n[3], n[4]}, n[5], {n[6], n[7], n[8]}};
}

/// Calls take(row) for every row beneath a header.
template<class Take>
void read_rows_beneath(const std::string& header, const std::string& text, const std::string& path,
                       const Take& take) {
  bool has_heading = false;
  std::size_t n_rows = 0;
  const auto check_heading = [&](const cases::TextRow& row) {
    has_heading = row.line == header;
    if (!has_heading) throw cases::InputError(row.place() + "must be the header " + header);
  };
  cases::read_rows(text, path, cases::Between::commas, check_heading, [&](const cases::TextRow& row) {
    if (!has_heading) check_heading(row);
    if (n_rows++ == most_recorded)
      throw cases::InputError(fmt::format("{}a recording may have {} rows", row.place(), most_recorded));
    take(row);
  });
}

std::vector<PullRow> rows_of(const std::string& text, const std::string& path, double step) {
  std::vector<PullRow> rows;
  read_rows_beneath(recording_header, text, path, [&](const cases::TextRow& row) {
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
  check_end(path, static_cast<double>(rows.back().step) * step, end);
  std::vector<Hold> holds = holds_of(rows);
  if (holds.size() > most_holds)
    throw cases::InputError(fmt::format("{}: has {} places, may have {}", path, holds.size(), most_holds));
  return holds;
}

std::vector<std::vector<std::array<double, 4>>> read_tool_recording(const std::string& text,
                                                                    const std::string& path, double step,
                                                                    double end, std::size_t n_tools) {
  std::vector<std::vector<std::array<double, 4>>> paths(n_tools);
  double last = 0;
  read_rows_beneath(tool_recording_header, text, path, [&](const cases::TextRow& row) {
    const auto refuse = [&](const std::string& problem) { throw cases::InputError(row.place() + problem); };
    const std::vector<double> n = numbers_of(row, 6);
    if (n.empty())
      refuse(fmt::format("must be six numbers up to 1e9 between commas: {}", tool_recording_header));
    if (!(n[0] == std::floor(n[0]) && n[0] >= 0)) refuse("step must be a whole number from 0");
    check_time(row, n[0], n[1], step);
    if (!(n[2] == std::floor(n[2]) && n[2] >= 0 && n[2] < static_cast<double>(n_tools)))
      refuse(fmt::format("tool must be a number of a [[tool]] of the case, which has {}, from 0", n_tools));
    auto& of_tool = paths[static_cast<std::size_t>(n[2])];
    if (!of_tool.empty() && !(n[1] > of_tool.back()[0]))
      refuse("step must be above that of the tool's line before");
    of_tool.push_back({n[1], n[3], n[4], n[5]});
    last = std::max(last, n[1]);
  });
  if (last == 0) throw cases::InputError(path + ": moves no tool");
  check_end(path, last, end);
  return paths;
}

} // namespace springproof::compare
