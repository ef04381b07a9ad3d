#pragma once

#include "cases/case/error.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <algorithm>
#include <optional>

namespace springproof::mechanics::grid {

/// What a coarser body with the same loads and supports tells of a path from rest.
struct CoarseGuess {
  std::optional<Vector> state; ///< near the equilibrium at the end; none where it was not found
  double first_load_step = 1;  ///< first to try on the path; below 1 where the coarse body failed
};

constexpr double guess_tolerance = 1e-3; ///< relative residual: a guess is worth no more

/// Finds the equilibrium of the coarser body.
/// @param coarser  what a still coarser one tells of it
template<class Equations>
CoarseGuess find_guess(Equations& equations, const Vector& rest, const char* what,
                       EquilibriumSettings settings, const CoarseGuess& coarser) {
  settings.tolerance = guess_tolerance;
  settings.smallest_load_step = 0.25;
  settings.max_convexified_per_step = 0; // it may not leave the path from rest
  settings.stability = Stability::ignore;
  settings.guess = coarser.state;
  settings.first_load_step = coarser.first_load_step;
  try {
    return {find_equilibrium(equations, rest, what, settings).state};
  } catch (const cases::SolveError& failed) { // the fine body has to find its own way
    return {std::nullopt,
            std::clamp(failed.so_far().load_reached / settings.to, settings.smallest_load_step, 0.5)};
  }
}

} // namespace springproof::mechanics::grid
