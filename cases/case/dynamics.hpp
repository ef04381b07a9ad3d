#pragma once

#include "cases/case/names.hpp"

/// What a case says of time. Units: s; densities, masses and accelerations as written, in kg/m³, kg and m/s².
namespace springproof::cases {

/// How a step in time is made; all of them are implicit.
SPRINGPROOF_ENUMERATION(Scheme,
                        implicit_euler,    ///< order 1, damps what it moves
                        newmark,           ///< beta and gamma; order 2 at gamma = 1/2
                        generalized_alpha, ///< order 2, damps what its steps do not resolve by rho_infinity
                        bdf2               ///< order 2, damps what its steps do not resolve to nothing
)

struct TimeScheme {
  Scheme scheme = Scheme::newmark;
  double beta = 0.25, gamma = 0.5; ///< newmark: 2 beta >= gamma >= 1/2, stable with any step
  double rho_infinity = 1;         ///< generalized_alpha, 0 to 1: what a step leaves of the fastest motion
};

} // namespace springproof::cases
