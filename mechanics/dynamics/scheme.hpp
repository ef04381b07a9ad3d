#pragma once

#include "cases/case/dynamics.hpp"

#include <optional>

namespace springproof::mechanics {

/// A combination of what is known when a step begins: its velocity v0 and acceleration a0; the displacement
/// u_before - u0 and the velocity v_before of the step before (bdf2).
struct KnownMotion {
  double velocity = 0, acceleration = 0, displacement_before = 0, velocity_before = 0;
  bool is_none() const {
    return velocity == 0 && acceleration == 0 && displacement_before == 0 && velocity_before == 0;
  }
};

/// A step of any scheme as one equation for a displacement w:
///   f_int(w) + M a* + C v* = F(t*),  a* = mass (w - u0) - known_acceleration,
///                                    v* = damping (w - u0) - known_velocity.
/// At its end u1 = u0 + (w - u0)/place, and v1 and a1 likewise.
struct StepCoefficients {
  double mass, damping; ///< 1/s², 1/s
  KnownMotion known_acceleration, known_velocity;
  double place = 1;              ///< position of w, v* and t* between the step's beginning (0) and end (1)
  double place_acceleration = 1; ///< position of a*
};

/// @param step         h, s, > 0
/// @param step_before  s, for bdf2; none: its first step, which is one of the implicit Euler method
/// Source: Newmark (1959); Chung and Hulbert (1993), with internal forces at w (generalised midpoint), which
/// at rho_infinity = 1 keeps momentum and angular momentum; bdf2 with unequal steps: Hairer, Norsett, Wanner
/// (1993), III.5.
StepCoefficients step_coefficients(const cases::TimeScheme& scheme, double step,
                                   std::optional<double> step_before);

/// Whether a step begins from the acceleration.
bool needs_acceleration(cases::Scheme scheme);

/// Order of the error of displacements and velocities.
int order_of(const cases::TimeScheme& scheme);

/// Damping ratio and period that a scheme gives an undamped oscillator. A step multiplies the swing by an
/// eigenvalue of the scheme's amplification matrix: its magnitude is the decay, its angle the advance in
/// phase. The implicit Euler method has 1/(1 - i omega h).
struct SwingsInSteps {
  double damping_ratio; ///< zeta, with zeta/sqrt(1 - zeta²) = decay over angle; omega h/2 to first
                        ///< order for the implicit Euler method
  double period;        ///< relative to the oscillator's: omega h over the angle
};
/// @param omega_h  angular frequency times step, > 0
/// @return a ratio of 1 and an infinite period where steps leave no swing
/// Source: Hughes, The Finite Element Method (1987), section 9.2, for the principal root.
SwingsInSteps swings_in_steps(const cases::TimeScheme& scheme, double omega_h);

} // namespace springproof::mechanics
