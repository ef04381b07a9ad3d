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
  double place = 1;              ///< of w, v* and t* on the way from the step's beginning (0) to its end (1)
  double place_acceleration = 1; ///< of a*
};

/// @param step         h, s, > 0
/// @param step_before  s; of bdf2, whose first step is one of the implicit Euler method
/// Source: Newmark (1959); Chung and Hulbert (1993), with internal forces at w (generalised midpoint), which
/// at rho_infinity = 1 keeps momentum and angular momentum; bdf2 with unequal steps: Hairer, Norsett, Wanner
/// (1993), III.5.
StepCoefficients step_coefficients(const cases::TimeScheme& scheme, double step,
                                   std::optional<double> step_before);

/// Whether a step begins from the acceleration.
bool needs_acceleration(cases::Scheme scheme);

/// Order of the error of displacements and velocities.
int order_of(const cases::TimeScheme& scheme);

/// Damping ratio that the implicit Euler method gives an undamped oscillator: omega h/2 to first order.
/// A step multiplies exp(i omega t) by 1/(1 - i omega h), of size (1 + omega² h²)^(-1/2) and angle
/// atan(omega h); the ratio of decay to angle is zeta/sqrt(1 - zeta²).
/// @param omega_h  angular frequency times step, >= 0
double implicit_euler_damping_ratio(double omega_h);

} // namespace springproof::mechanics
