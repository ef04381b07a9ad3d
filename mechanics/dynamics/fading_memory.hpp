#pragma once

#include "cases/case/case.hpp"
#include "mechanics/equilibrium/nonlinear_problem.hpp"

#include <vector>

namespace springproof::mechanics {

/// A branch of the Prony series of a case's materials: its moduli over those that are left in the end,
/// g/(1 - sum g) and k/(1 - sum k), 0 for a material that has no term of this time.
struct PronyBranch {
  double tau; ///< s
  struct Parts {
    double g = 0, k = 0;
  };
  std::vector<Parts> of_material; ///< as cases::materials_of() numbers them
};
std::vector<PronyBranch> prony_branches(const cases::Case& definition);

/// The memory of a body: numbers s, elastic forces of springs or stresses at points, with branches
///   q(t) = part * integral of exp(-(t - t')/tau) ds/dt' dt',
/// in which s goes straight from step to step. At the end of a step, or within it, s + sum q is
/// `factor` s + `remembered`: both are constants of the step, so that its equations are elastic ones.
/// Source: Taylor, Pister and Goudreau (1970); Simo and Hughes, Computational Inelasticity (1998), 10.3.
class FadingMemory {
 public:
  struct Branch {
    double tau;  ///< s
    Vector part; ///< each number's, from 0
  };
  explicit FadingMemory(const std::vector<Branch>& branches);

  /// Begins with numbers that have always been these: the branches have faded.
  void begin(const Vector& elastic);
  /// Sets factor() and remembered() for a time within the step.
  /// @param duration  s, since the last end_step(); infinite: all has faded
  void set_step(double duration);
  /// @param elastic  s at the end of the step    @param length  s
  void end_step(const Vector& elastic, double length);

  const Vector& factor() const { return factor_; }
  const Vector& remembered() const { return remembered_; }

 private:
  struct State {
    Branch branch;
    Vector faded; ///< q at the end of the last step
  };
  std::vector<State> states_;
  Vector last_; ///< s there
  Vector factor_, remembered_;
};

} // namespace springproof::mechanics
