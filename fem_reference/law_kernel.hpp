#pragma once

#include "fem_reference/element.hpp"

#include <Eigen/LU>
#include <cmath>
#include <vector>

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
      const Matrix3 f = Matrix3::Identity() + h;
      law_.stress(h, wanted, stress_);
      if (memory_.factor) remember(kinematics, f, q, wanted);
      if constexpr (Law::traits.split == Split::pressure) {
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
    const int at = CellMemory::n * q + CellMemory::pressure;
    const double factor = memory_.factor ? memory_.factor[at] : 1,
                 remembered = memory_.factor ? memory_.remembered[at] : 0;
    if (element_.pressure == Pressure::pointwise) {
      const ValueAndSlope elastic = law_.pressure(change);
      return {factor * elastic.value + remembered, factor * elastic.slope};
    }
    const double p = interpolated(g, q, pressure);
    const ValueAndSlope target = law_.dilatation((p - remembered) / factor);
    target_[static_cast<std::size_t>(q)] = {target.value, target.slope / factor};
    return {p, 0};
  }

  void elastic_of(const CellGeometry& g, const double* displacement, double* elastic) override {
    double growth = 0, volume = 0;
    std::vector<double> change(static_cast<std::size_t>(g.n_points));
    for (int q = 0; q < g.n_points; ++q) {
      const Matrix3 h = displacement_gradient(g, q, displacement, g.n_functions);
      change[static_cast<std::size_t>(q)] = dilatation(kinematics, h);
      growth += g.weights[q] * change[static_cast<std::size_t>(q)];
      volume += g.weights[q];
      law_.stress(h, Wanted::stress, stress_);
      Matrix3 s = stress_.stress.template reshaped<Eigen::RowMajor>(3, 3);
      if (kinematics == Kinematics::finite) s = (Matrix3::Identity() + h).inverse() * s;
      double* const to = elastic + CellMemory::n * q;
      for (int c = 0; c < 3; ++c) to[c] = s(c, c), to[3 + c] = s((c + 1) % 3, (c + 2) % 3);
      to[CellMemory::pressure] = 0;
    }
    if constexpr (Law::traits.split == Split::pressure)
      for (int q = 0; q < g.n_points; ++q)
        elastic[CellMemory::n * q + CellMemory::pressure] =
            law_.pressure(element_.pressure == Pressure::pointwise ? change[static_cast<std::size_t>(q)]
                                                                   : growth / volume)
                .value;
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
