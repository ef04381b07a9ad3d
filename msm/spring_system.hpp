#pragma once

#include "mechanics/equilibrium/nonlinear_problem.hpp"

namespace springproof::msm {

using mechanics::Vector;

/// A supported and loaded lattice. Vectors are displacements (mm) or forces (N).
class SpringSystem : public mechanics::NonlinearProblem {
 public:
  /// Applied forces at full load, N.
  virtual const Vector& load() const = 0;
  /// Norm of the forces that springs exert on supports, N: what a body that is only moved is measured
  /// against.
  virtual double reaction(const Vector& displacement) = 0;

  mechanics::Merit merit() const override { return mechanics::Merit::energy; }
  Size size(const Vector& residual, const Vector& at) override {
    const double load = this->load().norm();
    const double scale = load > 0 ? load : reaction(at);
    return {residual.norm() / (scale > 0 ? scale : 1.0)};
  }
  Work work() const override { return work_; }

 protected:
  Work work_;
};

} // namespace springproof::msm
