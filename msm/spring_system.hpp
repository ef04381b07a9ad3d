#pragma once

#include "mechanics/equilibrium/nonlinear_problem.hpp"
#include "msm/spring.hpp"

namespace springproof::msm {

using mechanics::Vector;

/// A supported and loaded lattice. Vectors are displacements (mm) or forces (N).
class SpringSystem : public mechanics::NonlinearProblem {
 public:
  /// Applied forces at full load, N.
  virtual const Vector& load() const = 0;

  mechanics::Merit merit() const override { return mechanics::Merit::energy; }
  Size size(const Vector& residual, const Vector& at) override {
    const double load = this->load().norm();
    const double scale = load > 0 ? load : reaction(at);
    return {residual.norm() / (scale > 0 ? scale : 1.0)};
  }
  std::optional<Vector> direction(const Vector& at, const Vector& residual, double, double forcing,
                                  mechanics::Convexity convexity) override {
    using mechanics::Convexity;
    return solve(at, residual, forcing,
                 convexity == Convexity::clamped ? TransverseTerm::clamped : TransverseTerm::exact,
                 convexity == Convexity::shifted ? 2 * std::abs(lowest_mode(at)->eigenvalue) : 0);
  }
  Work work() const override { return work_; }

 protected:
  Work work_;

  /// Norm of the forces that springs exert on supports, N: what a body that is only moved is measured
  /// against.
  virtual double reaction(const Vector& displacement) = 0;
  /// Solves (tangent + shift) * step = residual, as direction() asks for.  @param shift  N/mm
  virtual std::optional<Vector> solve(const Vector& displacement, const Vector& residual, double forcing,
                                      TransverseTerm term, double shift) = 0;
};

} // namespace springproof::msm
