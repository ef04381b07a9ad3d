#pragma once

#include "mechanics/dynamics/time_integrator.hpp"

#include <Eigen/Dense>
#include <functional>
#include <utility>

/// Bodies of a few degrees of freedom, whose motion is known.
namespace springproof::oscillator {

using mechanics::Vector;
using Matrix = Eigen::MatrixXd;

/// M a + C v + force(u) = load(t), with full matrices.
struct Body : mechanics::DynamicProblem {
  Matrix mass, damping;
  std::function<Vector(const Vector&)> force;     ///< N; not finite where there is none
  std::function<Matrix(const Vector&)> stiffness; ///< its derivative, N/mm
  std::function<Vector(double)> load;             ///< N
  std::function<double(double)> support;          ///< mm: where the first degree of freedom is; empty: free
  double least_mass_factor = 0;                   ///< 1/s²: below, the linear solver fails
  long n_evaluations = 0;

  void mass_product(const Vector& motion, Vector& product) override { product = on_free(mass * motion); }
  void damping_product(const Vector& motion, Vector& product) override {
    product = on_free(damping * motion);
  }
  void external_force(double time, Vector& at) override { at = on_free(load(time)); }
  void supports_at(double time, Vector& displacement) const override {
    if (support) displacement[0] = support(time);
  }
  void set_step(const mechanics::StepTerms& terms) override { terms_.emplace(terms); }

  void residual(const Vector& at, double, mechanics::Expect, Vector& residual) override {
    ++n_evaluations;
    const Matrix added = terms_->mass * mass + terms_->damping * damping;
    residual = on_free(terms_->force - force(at) - added * (at - terms_->origin));
  }
  Size size(const Vector& residual, const Vector&) override {
    return {relative(residual.norm(), terms_->scale)};
  }
  bool direction(const Vector& at, const Vector& residual, double, double, mechanics::Convexity,
                 Vector& step) override {
    if (terms_->mass < least_mass_factor) return false;
    Matrix tangent = terms_->mass * mass + terms_->damping * damping + stiffness(at);
    if (support) {
      tangent.row(0).setZero();
      tangent.col(0).setZero();
      tangent(0, 0) = 1;
    }
    step = tangent.partialPivLu().solve(residual);
    return true;
  }
  mechanics::Merit merit() const override { return mechanics::Merit::work; }
  std::optional<bool> is_stable(const Vector&) override { return std::nullopt; }
  std::size_t n_unknowns() const override {
    return static_cast<std::size_t>(mass.rows() - (support ? 1 : 0));
  }

 private:
  std::optional<mechanics::StepTerms> terms_;

  Vector on_free(Vector all) const {
    if (support) all[0] = 0;
    return all;
  }
};

inline Matrix rows(double a, double b, double c, double d) {
  Matrix result(2, 2);
  result << a, b, c, d;
  return result;
}

/// No damping, no load: to be given forces.
inline Body body(const Matrix& mass) {
  Body result;
  result.mass = mass;
  result.damping = Matrix::Zero(mass.rows(), mass.cols());
  result.load = [n = mass.rows()](double) { return Vector(Vector::Zero(n)); };
  return result;
}

inline Body linear(const Matrix& mass, const Matrix& stiffness) {
  Body result = body(mass);
  result.force = [stiffness](const Vector& u) { return Vector(stiffness * u); };
  result.stiffness = [stiffness](const Vector&) { return stiffness; };
  return result;
}

/// One mass of 1 t on a spring, of an angular frequency in 1/s.
inline Body simple(double omega) {
  return linear(Matrix::Identity(1, 1), Matrix::Constant(1, 1, omega * omega));
}

inline mechanics::Motion at(Vector displacement, Vector velocity) {
  return {0, std::move(displacement), std::move(velocity), {}};
}

inline mechanics::Motion released(double displacement) {
  return at(Vector::Constant(1, displacement), Vector::Zero(1));
}

constexpr cases::TimeScheme implicit_euler{cases::Scheme::implicit_euler};
constexpr cases::TimeScheme newmark{cases::Scheme::newmark};
constexpr cases::TimeScheme bdf2{cases::Scheme::bdf2};
constexpr cases::TimeScheme generalized_alpha(double rho_infinity) {
  return {cases::Scheme::generalized_alpha, 0.25, 0.5, rho_infinity};
}

} // namespace springproof::oscillator
