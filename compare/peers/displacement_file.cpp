#include "compare/peers/displacement_file.hpp"

#include "cases/case/error.hpp"
#include "compare/provenance/whole_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <sstream>

namespace springproof::compare {

namespace {

const std::string header = "x,y,z,ux,uy,uz";

std::string without_blanks(const std::string& text) {
  std::string result;
  for (const char c : text)
    if (c != ' ' && c != '\t' && c != '\r') result += c;
  return result;
}

/// The numbers of a line, or nothing if it is not six finite ones between commas.
std::vector<double> numbers_of(const std::string& line) {
  std::vector<double> values;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    double value = 0;
    const auto [stop, error] = std::from_chars(line.data() + begin, line.data() + end, value);
    if (error != std::errc() || stop != line.data() + end || !std::isfinite(value)) return {};
    values.push_back(value);
    begin = end + 1;
  }
  return values.size() == 6 ? values : std::vector<double>{};
}

} // namespace

std::vector<GivenDisplacement> read_displacement_csv(const std::string& text, const std::string& path) {
  std::istringstream stream(text);
  std::vector<GivenDisplacement> nodes;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    const std::string where = fmt::format("{}:{}", path, ++number);
    const std::string plain = without_blanks(line);
    if (number == 1) {
      if (plain != header)
        throw cases::InputError(fmt::format("{}: is '{}', must be the header {} (mm)", where, plain, header));
      continue;
    }
    if (plain.empty()) continue;
    const std::vector<double> v = numbers_of(plain);
    if (v.empty())
      throw cases::InputError(fmt::format("{}: is '{}', must be six finite numbers between commas: {} (mm)",
                                          where, plain, header));
    nodes.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, where});
  }
  if (number == 0) throw cases::InputError(path + ":1: is empty, must begin with the header " + header);
  return nodes;
}

std::vector<GivenDisplacement> read_displacements(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension();
  if (ending != ".csv" && ending != ".vtu")
    throw cases::InputError(
        fmt::format("{}: displacements must be in a file .csv ({}) or .vtu", path, header));
  const std::string text = read_file(path);
  return ending == ".csv" ? read_displacement_csv(text, path) : read_displacement_vtu(text, path);
}

} // namespace springproof::compare
