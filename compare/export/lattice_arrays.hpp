#pragma once

#include "compare/table/array_message.hpp"
#include "msm/lattice.hpp"

namespace springproof::compare {

/// Units of numbers that leave the program.
struct Units {
  double length; ///< how many make a mm
  double force;  ///< how many make a N
};

/// Arrays of a lattice's terms, an array each kind, some without rows: docs/reference/client-protocol.md has
/// their columns.
std::vector<NamedArray> lattice_arrays(const msm::Lattice& lattice, const Units& units);

} // namespace springproof::compare
