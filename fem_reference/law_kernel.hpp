#pragma once

#include "fem_reference/element.hpp"

#include <cmath>

namespace springproof::fem_reference {

/// Whether a law has finite forces where a point is turned inside out, J <= 0.
template<class Law>
constexpr bool is_finite_inside_out = Law::traits.kinematics == Kinematics::linear;

/// The element loop's part that depends on the law, which is inlined at every point.
template<class Law>
class LawKernel final : public CellKernel {
 public:
  LawKernel(const ElementType& element, Law law) : CellKernel(element), law_(std::move(law)) {}

 private:
  static constexpr Kinematics kinematics = Law::traits.kinematics;

  double energy_of(const CellGeometry& g, const double* displacement, const double* pressure) const override {
    double sum = 0;
    for (int q = 0; q < g.n_points; ++q) {
      const Matrix3 h = displacement_gradient(g, q, displacement, g.n_functions);
      double density = law_.energy(h);
      if constexpr (Law::traits.split == Split::pressure)
        density += law_.volume_energy(element_.pressure == Pressure::pointwise
                                          ? dilatation(kinematics, h)
                                          : law_.dilatation(interpolated(g, q, pressure)).value);
      sum += g.weights[q] * density;
    }
    return sum;
  }

  bool add_points(const CellGeometry& g, const double* displacement, const double* pressure,
                  Wanted wanted) override {
    for (int q = 0; q < g.n_points; ++q) {
      const auto point = static_cast<std::size_t>(q);
      const Matrix3 h = displacement_gradient(g, q, displacement, g.n_functions);
      const double change = dilatation(kinematics, h);
      // written so that NaN is refused
      const bool is_admissible = is_finite_inside_out<Law> ? std::isfinite(change) : change > -1;
      if (!is_admissible) return false;
      dilatation_[point] = change;
      law_.stress(h, wanted, stress_);
      if constexpr (Law::traits.split == Split::pressure) {
        const Matrix3 f = Matrix3::Identity() + h;
        cofactor_[point] = cofactor(kinematics, f);
        add_pressure(f, q, pressure_at(g, q, change, pressure), wanted);
      }
      add_point(g, q, wanted);
    }
    return true;
  }

  double interpolated(const CellGeometry& g, int q, const double* pressure) const {
    double p = 0;
    for (int m = 0; m < element_.n_pressure_modes; ++m)
      p += g.modes[q * element_.n_pressure_modes + m] * pressure[m];
    return p;
  }

  /// With modes the pressure is interpolated and its slope left to condensation.
  ValueAndSlope pressure_at(const CellGeometry& g, int q, double change, const double* pressure) {
    if (element_.pressure == Pressure::pointwise) return law_.pressure(change);
    const double p = interpolated(g, q, pressure);
    target_[static_cast<std::size_t>(q)] = law_.dilatation(p);
    return {p, 0};
  }

  void add_pressure(const Matrix3& f, int q, const ValueAndSlope& pressure, Wanted wanted) {
    const Vector9 area = flatten(cofactor_[static_cast<std::size_t>(q)]);
    stress_.stress += pressure.value * area;
    if (wanted == Wanted::stress) return;
    add_cofactor_derivative(kinematics, f, pressure.value, stress_.tangent);
    if (element_.pressure == Pressure::pointwise)
      stress_.tangent.noalias() += pressure.slope * area * area.transpose();
  }

  Law law_;
};

} // namespace springproof::fem_reference
