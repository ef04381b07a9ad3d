#include "cases/scene/network.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

namespace springproof::cases {

namespace {

std::string without_blanks(const std::string& text) {
  const char* const blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');) fields.push_back(without_blanks(field));
  return fields;
}

/// The fields of one line, by their places.
struct Row {
  std::vector<std::string> fields;
  std::string place; ///< "NAME:LINE: "

  [[noreturn]] void refuse(std::size_t field, const char* name, const std::string& allowed) const {
    throw InputError(fmt::format("{}{} is {}, must be {}", place, name,
                                 field < fields.size() && !fields[field].empty() ? fields[field] : "missing",
                                 allowed));
  }

  template<class Value>
  std::optional<Value> value(std::size_t field) const {
    if (field >= fields.size()) return std::nullopt;
    const std::string& text = fields[field];
    Value value{};
    const auto end = text.data() + text.size(), read = std::from_chars(text.data(), end, value).ptr;
    return read == end && !text.empty() ? std::optional(value) : std::nullopt;
  }

  int node(std::size_t field, const char* name, std::size_t n_nodes) const {
    const auto found = value<int>(field);
    if (!found || *found < 0 || static_cast<std::size_t>(*found) >= n_nodes)
      refuse(field, name, fmt::format("the number of a node, from 0 to {}", n_nodes - 1));
    return *found;
  }

  template<class Condition>
  double number(std::size_t field, const char* name, const char* allowed, const Condition& is_allowed) const {
    const auto found = value<double>(field);
    if (!found || !std::isfinite(*found) || !is_allowed(*found)) refuse(field, name, allowed);
    return *found;
  }

  bool has(std::size_t field) const { return field < fields.size() && !fields[field].empty(); }
};

constexpr auto is_above_0 = [](double value) { return value > 0; };

NetworkSpring spring_of(const Row& row, std::size_t n_nodes) {
  if (row.fields.size() < 3 || row.fields.size() > 5)
    throw InputError(
        fmt::format("{}{} fields; a spring has node a, node b, stiffness (N/m), and perhaps rest "
                    "length (mm) and exponent",
                    row.place, row.fields.size()));
  NetworkSpring spring{row.node(0, "node a", n_nodes), row.node(1, "node b", n_nodes),
                       1e-3 * row.number(2, "stiffness", "a number above 0 (N/m)", is_above_0)};
  if (spring.a == spring.b) row.refuse(1, "node b", "another node than node a");
  if (row.has(3)) spring.rest_length = row.number(3, "rest length", "a number above 0 (mm)", is_above_0);
  if (row.has(4))
    spring.exponent =
        row.number(4, "exponent", "a number from -20 to 20", [](double p) { return -20 <= p && p <= 20; });
  return spring;
}

} // namespace

std::vector<NetworkSpring> read_network(const std::string& text, const std::string& name,
                                        std::size_t n_nodes) {
  std::vector<NetworkSpring> springs;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line = without_blanks(line);
    if (line.empty() || line.front() == '#' || std::isalpha(static_cast<unsigned char>(line.front())) != 0)
      continue;
    springs.push_back(spring_of({fields_of(line), fmt::format("{}:{}: ", name, number)}, n_nodes));
  }
  if (springs.empty()) throw InputError(name + ": a network needs at least one spring");
  return springs;
}

} // namespace springproof::cases
