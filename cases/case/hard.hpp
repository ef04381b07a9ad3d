#pragma once

#include "cases/case/body.hpp"
#include "cases/case/designs.hpp"

/// [stress] of a hard case.
namespace springproof::cases {

/// The two models that are compared.
SPRINGPROOF_ENUMERATION(Side, fem, msm)

/// Where the springs' search for equilibrium begins.
SPRINGPROOF_ENUMERATION(
    Start, rest,
    perturbed, ///< every point moved by up to an amplitude in each component
    inverted   ///< the body mirrored at its lowest plane of z: every cell inside out, held points excepted
)

/// What must become of one model of a hard case.
struct ExpectedOutcome {
  std::string model; ///< name of its table
  Side side;
  std::optional<Design> design; ///< springs in place of the case's own with all its settings
  Outcome outcome;
  std::optional<std::array<double, 2>> load_reached; ///< closed interval; 1: the full load
  std::optional<int> inverted_cells;
};
SPRINGPROOF_FIELDS(ExpectedOutcome, model, side, design, outcome, load_reached, inverted_cells)

/// The part of a body beyond a plane, whose springs are stiffer by a factor.
struct Stiffer {
  Axis axis;
  double beyond; ///< mm: cells whose centre lies beyond
  double factor; ///< > 0
};
SPRINGPROOF_FIELDS(Stiffer, axis, beyond, factor)

/// What makes a case hard: [stress]. Given stiffnesses, of any sign, stand in [msm].
struct Stress {
  bool is_heavy = false; ///< takes minutes: run when asked for
  Start start = Start::rest;
  double amplitude = 0;                  ///< mm; perturbed
  int seed = 0;                          ///< perturbed
  std::optional<Stiffer> stiffer;        ///< springs only
  int least_load_steps = 1;              ///< equal or smaller ones
  double max_seconds = 0;                ///< each solve
  int max_iterations = 0;                ///< Newton's method, each solve
  std::vector<ExpectedOutcome> expected; ///< one per model that is solved, at least one
};
SPRINGPROOF_FIELDS(Stress, is_heavy, start, amplitude, seed, stiffer, least_load_steps, max_seconds,
                   max_iterations, expected)

} // namespace springproof::cases
