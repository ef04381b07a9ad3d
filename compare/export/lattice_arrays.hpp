#pragma once

#include "msm/lattice.hpp"

#include <string>

namespace springproof::compare {

/// Rows of numbers, one row after the other.
struct NumberArray {
  std::size_t columns;
  std::vector<double> values{};

  template<class Nodes>
  void add_nodes(const Nodes& nodes) {
    for (const int node : nodes) values.push_back(node);
  }
  void add(std::initializer_list<double> some) { values.insert(values.end(), some); }
};

/// Units of numbers that leave the program.
struct Units {
  double length; ///< how many make a mm
  double force;  ///< how many make a N
};

struct NamedArray {
  std::string name;
  NumberArray array;
};

/// Arrays of a lattice's terms, an array each kind, some without rows: docs/reference/client-protocol.md has
/// their columns.
std::vector<NamedArray> lattice_arrays(const msm::Lattice& lattice, const Units& units);

} // namespace springproof::compare
