#pragma once

#include "cases/case/dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

/// Closed forms of a material with one branch: modulus 1 in the end, and `part` that fades in the time tau.
namespace springproof::creep {

/// Strain under a stress that grows from 0 to 1 in the time `ramp` and stays: the integral of the creep
/// compliance J(t) = 1 - part/(1 + part) exp(-t/T), T = tau (1 + part).
inline double strain(double time, double ramp, double part, double tau) {
  const double retardation = tau * (1 + part), share = part / (1 + part);
  const auto integral = [&](double t) {
    return t <= 0 ? 0 : t + share * retardation * std::expm1(-t / retardation);
  };
  return (integral(time) - integral(time - ramp)) / ramp;
}

/// Stress under a strain that grows from 0 to 1 in the time `ramp` and stays.
inline double stress(double time, double ramp, double part, double tau) {
  const auto integral = [&](double t) { return t <= 0 ? 0 : t - part * tau * std::expm1(-t / tau); };
  return (integral(time) - integral(time - ramp)) / ramp;
}

/// A case's g or k, of which a branch's part is g/(1 - g).
inline double part_of(double g) {
  return g / (1 - g);
}

constexpr double ramp = 0.05, tau = 0.1, end = 0.3; ///< s, of the tests of both models

/// Steps of a motion whose load grows in `ramp`.
inline cases::Dynamics steps(const cases::TimeScheme& scheme, double step) {
  cases::Dynamics dynamics;
  dynamics.scheme = scheme;
  dynamics.step = step;
  dynamics.end = end;
  dynamics.write_every = 100000;
  return dynamics;
}
inline cases::History grows() {
  cases::History history;
  history.points = {{0, 0}, {ramp, 1}};
  return history;
}

} // namespace springproof::creep
