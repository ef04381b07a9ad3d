#include "cases/case/input_file.hpp"
#include "cases/scene/loads.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::cases {

namespace {

/// A row and the checks of its fields.
struct Row {
  const TextRow& row;

  [[noreturn]] void refuse(std::size_t field, const char* name, const std::string& allowed) const {
    throw InputError(fmt::format("{}{} is {}, must be {}", row.place(), name,
                                 has(field) ? row.fields[field] : "missing", allowed));
  }

  template<class Value>
  std::optional<Value> value(std::size_t field) const {
    return field < row.fields.size() ? number_in<Value>(row.fields[field]) : std::nullopt;
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
    if (!found || !is_allowed(*found)) refuse(field, name, allowed);
    return *found;
  }

  bool has(std::size_t field) const { return field < row.fields.size() && !row.fields[field].empty(); }
};

constexpr auto is_above_0 = [](double value) { return value > 0; };

Eigen::Vector3d place_of(const Row& row) {
  const auto is_place = [](double value) { return std::abs(value) <= 1e9; };
  Eigen::Vector3d place;
  for (std::size_t a = 0; a < 3; ++a)
    place[static_cast<Eigen::Index>(a)] =
        row.number(a, std::array{"x", "y", "z"}[a], "a number from -1e9 to 1e9 (mm)", is_place);
  return place;
}

NetworkSpring spring_of(const Row& row, std::size_t n_nodes) {
  if (row.row.fields.size() < 3 || row.row.fields.size() > 5)
    throw InputError(fmt::format("{}{} fields; a spring has node a, node b, stiffness (N/m), and perhaps "
                                 "rest length (mm) and exponent",
                                 row.row.place(), row.row.fields.size()));
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

NetworkNodes read_nodes(const std::string& text, const std::string& name) {
  NetworkNodes nodes;
  const auto add = [&](const TextRow& line) {
    const Row row{line};
    if (line.fields.size() != 3 && line.fields.size() != 4)
      throw InputError(fmt::format("{}{} fields; a node has x, y, z (mm), and perhaps mass (kg)",
                                   line.place(), line.fields.size()));
    if (nodes.places.size() == 715'000'000)
      throw InputError(line.place() + "more than 715 million nodes cannot be numbered");
    const bool has_mass = row.has(3);
    if (!nodes.places.empty() && has_mass == nodes.masses.empty())
      row.refuse(3, "mass", has_mass ? "left out as before" : "there as before (kg)");
    nodes.places.push_back(place_of(row));
    if (has_mass)
      nodes.masses.push_back(tonnes_per_kg *
                             row.number(3, "mass", "a number from 1e-12 to 1000000 (kg)",
                                        [](double mass) { return 1e-12 <= mass && mass <= 1e6; }));
  };
  read_rows(
      text, name, Between::commas, [](const TextRow&) {}, add);
  if (nodes.places.empty()) throw InputError(name + ": a network needs at least one node");
  return nodes;
}

std::vector<NetworkSpring> read_network(const std::string& text, const std::string& name,
                                        std::size_t n_nodes) {
  std::vector<NetworkSpring> springs;
  read_rows(
      text, name, Between::commas, [](const TextRow&) {},
      [&](const TextRow& row) { springs.push_back(spring_of({row}, n_nodes)); });
  if (springs.empty()) throw InputError(name + ": a network needs at least one spring");
  return springs;
}

std::vector<std::string> doubts_of(const std::vector<NetworkSpring>& springs,
                                   const std::function<Eigen::Vector3d(int)>& node) {
  constexpr double far = 0.1; // relative to the distance
  std::vector<std::array<int, 2>> pairs;
  std::size_t n_far = 0;
  double farthest = 0;
  const NetworkSpring* worst = nullptr;
  for (const NetworkSpring& spring : springs) {
    pairs.push_back({std::min(spring.a, spring.b), std::max(spring.a, spring.b)});
    if (!spring.rest_length) continue;
    const double distance = (node(spring.a) - node(spring.b)).norm();
    const double off = std::abs(*spring.rest_length - distance);
    if (off <= far * distance) continue;
    ++n_far;
    if (worst == nullptr || off / distance > farthest) {
      farthest = off / distance;
      worst = &spring;
    }
  }
  std::vector<std::string> doubts;
  std::sort(pairs.begin(), pairs.end());
  const auto first = std::adjacent_find(pairs.begin(), pairs.end());
  if (first != pairs.end()) {
    const std::array<int, 2> twice = *first;
    const auto n = pairs.end() - std::unique(pairs.begin(), pairs.end());
    doubts.push_back(fmt::format("{} of {} springs join two nodes that another one joins already, nodes {} "
                                 "and {} for one: their forces add up",
                                 n, springs.size(), twice[0], twice[1]));
  }
  if (worst != nullptr)
    doubts.push_back(
        fmt::format("{} of {} springs have a rest length more than {:g} % from the distance of their nodes, "
                    "that of nodes {} and {} {:.4g} mm for {:.4g} mm: the body is not at rest without loads",
                    n_far, springs.size(), 100 * far, worst->a, worst->b, *worst->rest_length,
                    (node(worst->a) - node(worst->b)).norm()));
  return doubts;
}

} // namespace springproof::cases
