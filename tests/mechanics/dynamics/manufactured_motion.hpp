#pragma once

#include "mechanics/dynamics/time_integrator.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace springproof {

/// A model's body that loads of its own make move as it is told: shape * sin(omega t), shape 0 on supports.
class ManufacturedMotion : public mechanics::DynamicProblem {
 public:
  using Vector = mechanics::Vector;

  ManufacturedMotion(DynamicProblem& body, Vector shape, double omega)
      : body_(body), shape_(std::move(shape)), omega_(omega) {}

  Vector displacement(double time) const { return std::sin(omega_ * time) * shape_; }
  Vector velocity(double time) const { return omega_ * std::cos(omega_ * time) * shape_; }

  /// M a + C v + f_int(u) of the motion.
  void external_force(double time, Vector& force) override {
    const Vector at = displacement(time), none = Vector::Zero(shape_.size());
    body_.set_step({0, 0, at, none, at, 1});
    Vector product(shape_.size());
    force = -body_.residual(at, 0);
    body_.mass_product(-omega_ * omega_ * at, product);
    force += product;
    body_.damping_product(velocity(time), product);
    force += product;
  }
  void mass_product(const Vector& of, Vector& product) override { body_.mass_product(of, product); }
  void damping_product(const Vector& of, Vector& product) override { body_.damping_product(of, product); }
  void supports_at(double time, Vector& at) const override { body_.supports_at(time, at); }
  void complete(Vector& of) override { body_.complete(of); }
  void set_step(const mechanics::StepTerms& terms) override { body_.set_step(terms); }
  void residual(const Vector& at, double load_factor, mechanics::Expect expect, Vector& residual) override {
    body_.residual(at, load_factor, expect, residual);
  }
  Size size(const Vector& residual, const Vector& at) override { return body_.size(residual, at); }
  bool direction(const Vector& at, const Vector& residual, double load_factor, double forcing,
                 mechanics::Convexity convexity, Vector& step) override {
    return body_.direction(at, residual, load_factor, forcing, convexity, step);
  }
  mechanics::Merit merit() const override { return body_.merit(); }
  double energy(const Vector& at, double load_factor) override { return body_.energy(at, load_factor); }
  std::optional<bool> is_stable(const Vector& at) override { return body_.is_stable(at); }
  double dot(const Vector& left, const Vector& right) const override { return body_.dot(left, right); }
  double largest(const Vector& of) const override { return body_.largest(of); }

 private:
  DynamicProblem& body_;
  Vector shape_;
  double omega_;
};

/// The error after an eighth of a second of a motion of 5 Hz falls with the step as each scheme says.
/// @param n_steps  the coarser run's number of steps
inline void check_orders(mechanics::DynamicProblem& body, const mechanics::Vector& shape, int n_steps) {
  const auto error = [&](const cases::TimeScheme& scheme, int n) {
    ManufacturedMotion problem(body, shape, 10 * std::acos(-1.0));
    constexpr double end = 0.125;
    mechanics::TimeIntegrator motion(problem, scheme, {0, problem.displacement(0), problem.velocity(0), {}});
    for (int step = 1; step <= n; ++step) motion.advance(end * step / n);
    return (motion.now().displacement - problem.displacement(end)).norm();
  };
  using cases::Scheme;
  const std::vector<std::pair<cases::TimeScheme, double>> orders = {
      {{Scheme::implicit_euler}, 1.},
      {{Scheme::newmark}, 2.},
      {{Scheme::generalized_alpha, 0.25, 0.5, 0.5}, 2.},
      {{Scheme::bdf2}, 2.}};
  for (const auto& [scheme, order] : orders) {
    INFO(name_of(scheme.scheme));
    const double coarse = error(scheme, n_steps), fine = error(scheme, 2 * n_steps);
    CHECK(coarse < 0.05 * shape.norm());
    CHECK(std::log2(coarse / fine) == Approx(order).margin(0.05));
  }
}

} // namespace springproof
