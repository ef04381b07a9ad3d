#pragma once

#include "cases/case/case.hpp"
#include "cases/case/names.hpp"
#include "cases/case/outcome.hpp"
#include "cases/case/side.hpp"

namespace springproof::cases {

/// Where the springs' search for equilibrium begins.
enum class Start {
  rest,
  perturbed, ///< every point moved by up to an amplitude in each component
  inverted   ///< the body mirrored at its lowest plane of z: every cell inside out, held points excepted
};

/// What must become of one model.
struct ExpectedOutcome {
  Side side;
  Outcome outcome;
  std::optional<std::array<double, 2>> load_reached; ///< closed, of the full load
  std::optional<int> inverted_cells;
  Where where;
};

/// The part of a body beyond a plane, whose springs are stiffer by a factor.
struct Stiffer {
  Axis axis;
  double beyond; ///< mm: cells whose centre lies beyond
  double factor; ///< > 0
};

/// A case made to break a solver, and what must become of it: a case file with a table [stress].
struct HardCase {
  Case definition;
  bool is_heavy = false; ///< takes minutes: run when asked for
  Start start = Start::rest;
  double amplitude = 0;                           ///< mm; perturbed
  int seed = 0;                                   ///< perturbed
  std::optional<std::array<double, 3>> stiffness; ///< N/m: k_e, k_f, k_d of any sign in place of the design
  std::optional<Stiffer> stiffer;                 ///< springs only
  int least_load_steps = 1;                       ///< of equal size or smaller
  double max_seconds = 0;                         ///< of each solve
  int max_iterations = 0;                         ///< of Newton's method, of each solve
  std::vector<ExpectedOutcome> expected;          ///< one per side that is solved, at least one
};

template<>
const NameTable<Side>& names();
template<>
const NameTable<Start>& names();

/// Reads a case file with a table [stress]; otherwise as read_case(), which refuses such a file.
/// @throws InputError
HardCase read_hard_case(const std::string& path, const std::vector<std::string>& overrides = {});

} // namespace springproof::cases
