#pragma once

#include "cases/case/error.hpp"

#include <array>
#include <optional>
#include <vector>

/// What a case says of time. Units as written: s, kg/m³, kg, m/s²; inside a scene masses are in tonnes
/// (N s²/mm) and accelerations in mm/s².
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
SPRINGPROOF_FIELDS(TimeScheme, scheme, beta, gamma, rho_infinity)

/// Where a motion begins.
SPRINGPROOF_ENUMERATION(MotionStart,
                        rest,       ///< undeformed, without velocity
                        equilibrium ///< under the loads just before time 0, without velocity
)

constexpr double most_time_steps = 1e7; ///< per case

struct Dynamics {
  TimeScheme scheme;
  double step = 0, end = 0; ///< s, > 0; the end is a whole number of steps
  MotionStart start = MotionStart::rest;
  int write_every = 1; ///< steps from one written body to the next
  Where where;

  int n_steps() const;
};
SPRINGPROOF_FIELDS(Dynamics, scheme, step, end, start, write_every, where)

/// The factor of a load or motion over time.
struct History {
  /// Time (s) and factor, times not descending: linear between them, constant before and after them, a jump
  /// where two times are equal. Empty: 1 at all times, or the sine.
  std::vector<std::array<double, 2>> points{};
  double frequency = 0; ///< Hz; other than 0: sin(2 pi frequency t)

  bool is_given() const { return !points.empty() || frequency != 0; }
  double at(double time) const;          ///< at a jump what comes after it
  double just_before(double time) const; ///< at a jump what comes before it
  bool jumps() const;
  /// The smallest and the largest factor from one time to another (s), ends included: above 1 and below 0
  /// too.
  std::array<double, 2> factors_between(double begin, double end) const;
};
SPRINGPROOF_FIELDS(History, points, frequency)

/// A term of a Prony series: parts g and k of the instantaneous shear and bulk modulus that fade with the
/// time tau,
///   G(t) = G0 (1 - sum g (1 - exp(-t/tau))),  K(t) = K0 (1 - sum k (1 - exp(-t/tau))).
/// A case's own moduli are those that are left in the end: G0 = G/(1 - sum g), K0 = K/(1 - sum k).
struct PronyTerm {
  double g = 0, k = 0; ///< from 0; each sum is below 1
  double tau = 1;      ///< s, > 0
};
SPRINGPROOF_FIELDS(PronyTerm, g, k, tau)

/// What a material adds to its elasticity: C = mass_damping M + stiffness_damping K(rest) of its cells, and
/// its memory.
struct MaterialDynamics {
  std::optional<double> density; ///< kg/m³
  double mass_damping = 0;       ///< alpha, 1/s, >= 0
  double stiffness_damping = 0;  ///< beta, s, >= 0
  std::vector<PronyTerm> prony{};
};
SPRINGPROOF_FIELDS(MaterialDynamics, density, mass_damping, stiffness_damping, prony)

/// Mass matrix of the finite elements.
SPRINGPROOF_ENUMERATION(ElementMass, consistent,
                        lumped ///< each node's share of its element's mass, on the diagonal
)

/// Masses of the springs' points.
SPRINGPROOF_ENUMERATION(PointMass,
                        cells,     ///< an eighth of every cell that a point belongs to
                        uniform,   ///< the same for every point: the body's mass over their number
                        consistent ///< integral of density N_a N_b over trilinear cells, not diagonal
)

/// A number of a measure's course over time.
SPRINGPROOF_ENUMERATION(OverTime,
                        end,           ///< the last value
                        settled,       ///< what it swings about: mean of the last whole swings
                        peak,          ///< the value that is furthest from the first one
                        peak_time,     ///< s
                        overshoot,     ///< peak beyond the settled value, percent of the way there
                        frequency,     ///< its swings, Hz
                        damping_ratio, ///< from the logarithmic decrement of its swings
                        trajectory_l2  ///< root mean square over time
)

} // namespace springproof::cases
