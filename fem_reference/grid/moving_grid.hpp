#pragma once

#include "fem_reference/grid/grid_equations.hpp"

namespace springproof::fem_reference::grid {

/// The motion of elements on a grid, on the states and with the forces of their static equations. Pressures
/// have no inertia. Of a rank, vectors are those of GridEquations, with current ghosts; forces and products
/// mean something in the planes that it computes.
class MovingGrid : public mechanics::DynamicProblem {
 public:
  using Vector = mechanics::Vector;
  /// @param scene      with the mesh of the elements
  /// @param places, supported, equations  of the same body; must outlive this
  MovingGrid(const cases::Scene& scene, const Places& places, const Supported& supported,
             GridEquations& equations, int n_threads);

  void mass_product(const Vector& motion, Vector& product) override { multiply(1, 0, motion, product); }
  void damping_product(const Vector& motion, Vector& product) override { multiply(0, 1, motion, product); }
  void external_force(double time, Vector& force) override;
  void supports_at(double time, Vector& displacement) const override;
  void complete(Vector& motion) override;
  std::vector<Run> runs(Eigen::Index size) const override { return equations_.runs(size); }
  void set_step(const mechanics::StepTerms& terms) override;

  using NonlinearProblem::direction;
  using NonlinearProblem::residual;
  void residual(const Vector& at, double load_factor, mechanics::Expect expect, Vector& residual) override {
    equations_.residual(at, load_factor, expect, residual);
  }
  Size size(const Vector& residual, const Vector& at) override { return equations_.size(residual, at); }
  bool direction(const Vector& at, const Vector& residual, double load_factor, double forcing,
                 mechanics::Convexity convexity, Vector& step) override {
    return equations_.direction(at, residual, load_factor, forcing, convexity, step);
  }
  mechanics::Merit merit() const override { return equations_.merit(); }
  std::optional<bool> is_stable(const Vector& /*at*/) override { return std::nullopt; }
  double dot(const Vector& left, const Vector& right) const override { return equations_.dot(left, right); }
  bool any_rank(bool here) const override { return equations_.any_rank(here); }
  Work work() const override { return equations_.work(); }
  std::size_t n_unknowns() const override { return equations_.n_unknowns(); }

 private:
  const Body& body_;
  const Supported& supported_;
  GridEquations& equations_;
  Inertia inertia_;
  std::vector<mechanics::LoadInTime> loads_;
  Field<double> motion_, product_;

  void multiply(double mass, double damping, const Vector& motion, Vector& product);
};

} // namespace springproof::fem_reference::grid
