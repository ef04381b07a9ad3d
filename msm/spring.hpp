#pragma once

#include "msm/spring_laws.hpp"

#include <Eigen/Core>
#include <cmath>
#include <tuple>

namespace springproof::msm {

/// The functions of laws for one number, to its last digits.
struct Exact {
  static constexpr double of_exponential = 1;
  static double length(double squared) { return std::sqrt(squared); }
  /// k (1 - l0/|d|), exactly 0 at rest.
  static double elongation_share(double k, double rest, double squared) {
    return k * (1 - rest / std::sqrt(squared));
  }
  static double over_squared(double x, double squared) { return x / squared; }
  /// ln q, without the digits that q = 1.000... would lose.
  static double log_stretch(double squared, double rest, double) {
    return std::log1p((std::sqrt(squared) - rest) / rest);
  }
  static double exponential(double x) { return std::exp(x); }
  static double log_volume(double ratio, double) { return std::log(ratio); }
};

/// A law and its parameter.
struct SpringLaw {
  LawKind kind = LawKind::hooke;
  double parameter = 0;
};
inline bool operator==(const SpringLaw& a, const SpringLaw& b) {
  return std::tie(a.kind, a.parameter) == std::tie(b.kind, b.parameter);
}
inline bool operator<(const SpringLaw& a, const SpringLaw& b) {
  return std::tie(a.kind, a.parameter) < std::tie(b.kind, b.parameter);
}

struct Spring {
  double stiffness;   ///< k at rest, N/mm
  double rest_length; ///< l0, mm, > 0
  SpringLaw law{};
  double remembered = 0; ///< N, tension that a material's memory adds to the law's
};

/// action(law) with the spring's rest length and parameter.
template<class Action>
SPRINGPROOF_INLINE auto with_law(const Spring& spring, const Action& action) {
  return with_law<double, Exact>(spring.law.kind, [&](auto law) {
    return action(typename decltype(law)::type(spring.rest_length, spring.law.parameter));
  });
}

/// Energy of a spring: Hooke's is k/2 (|d| - l0)².  @param d  x_j - x_i, mm  @return N mm
inline double spring_energy(const Eigen::Vector3d& d, const Spring& spring) {
  const double energy = with_law(
      spring, [&](const auto& law) { return law.twice_energy(d.squaredNorm(), spring.stiffness) / 2; });
  if (spring.remembered == 0) return energy;
  return energy + spring.remembered * (d.norm() - spring.rest_length);
}

/// What a spring's second derivative is made of.
struct SpringSlopes {
  double along;      ///< dT/d|d|, N/mm
  double transverse; ///< T/|d|, N/mm
};

inline SpringSlopes spring_slopes(double length, const Spring& spring) {
  return with_law(spring, [&](const auto& law) -> SpringSlopes {
    const auto tangent = law.template tangent<Clamp::no>(length * length, spring.stiffness);
    return {tangent.transverse + tangent.along * length * length, tangent.transverse};
  });
}

/// Force on point i from the spring (i, j):  f = T d/|d|,  d = x_j - x_i: it pulls i towards j when
/// stretched; point j receives the opposite. The points must not coincide.
/// @param d  x_j - x_i, mm  @return N
/// Source: thesis eq. 4.8 (Hooke); minus the gradient of spring_energy() with respect to x_i.
inline Eigen::Vector3d spring_force(const Eigen::Vector3d& d, const Spring& spring) {
  const double of_law =
      with_law(spring, [&](const auto& law) { return law.transverse(d.squaredNorm(), spring.stiffness); });
  return (spring.remembered == 0 ? of_law : of_law + spring.remembered / d.norm()) * d;
}

/// Second derivative of spring_energy() with respect to d:
///   dT/d|d| n n^T + T/|d| (I - n n^T),  n = d/|d|.
/// The transverse factor is negative in a compressed spring, the other one where a power-log spring has
/// passed its largest tension; clamped, both are at least 0 and the matrix positive semidefinite.
/// @param d  mm  @return N/mm, symmetric; the (i, i) and (j, j) blocks of the tangent get it, (i, j) its
/// negative
inline Eigen::Matrix3d spring_stiffness(const Eigen::Vector3d& d, const Spring& spring, Clamp clamp) {
  const double squared = d.squaredNorm(), k = spring.stiffness;
  SpringTangent<double> tangent = with_law(spring, [&](const auto& law) {
    return clamp == Clamp::yes ? law.template tangent<Clamp::yes>(squared, k)
                               : law.template tangent<Clamp::no>(squared, k);
  });
  if (spring.remembered != 0) { // a tension that does not change with the length
    const double along = tangent.transverse + tangent.along * squared;
    const double transverse = spring_force(d, spring).dot(d) / squared;
    tangent.transverse = clamp == Clamp::yes ? not_negative(transverse) : transverse;
    tangent.along = (along - tangent.transverse) / squared;
  }
  return tangent.transverse * Eigen::Matrix3d::Identity() + tangent.along * d * d.transpose();
}

/// A volume term's law: its pressure (tension-positive) as a function of the volume ratio J of the cell, over
/// k_v, with its integral from 1 and its derivative. Linear beside Hooke's springs: J - 1; logarithmic beside
/// power-log springs: ln J, which is no number at J <= 0, so that no state with such a cell is accepted.
struct VolumeLaw {
  double integral, pressure, slope;
};
inline VolumeLaw volume_law(double volume_ratio, bool is_logarithmic) {
  const auto of = [&](const auto& law) -> VolumeLaw {
    return {law.twice_energy(volume_ratio, 1.0) / 2, law.pressure(volume_ratio, 1),
            law.template slope<Clamp::no>(volume_ratio, 1)};
  };
  return is_logarithmic ? of(LogarithmicVolume<double, Exact>{1}) : of(LinearVolume<double>{1});
}
/// Name of a law's parameter, null where it has none.
inline const char* parameter_name(LawKind kind) {
  return with_law<double, Exact>(kind, [](auto law) { return decltype(law)::type::parameter; });
}
/// Whether the volume terms beside springs of the law are logarithmic.
inline bool has_logarithmic_volume(LawKind kind) {
  return with_law<double, Exact>(kind, [](auto law) { return decltype(law)::type::Volume::is_logarithmic; });
}

} // namespace springproof::msm
