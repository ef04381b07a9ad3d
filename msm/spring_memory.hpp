#pragma once

#include "cases/scene/scene.hpp"
#include "mechanics/dynamics/fading_memory.hpp"
#include "msm/problem.hpp"
#include "msm/spring_body.hpp"

namespace springproof::msm {

/// The memory of a lattice: the tension of every spring and the pressure of every volume term have the
/// branches of their cells' materials. Tensions fade by g, pressures by k. They act along the springs as
/// these are, so that a body that turns remembers nothing of it.
class SpringMemory {
 public:
  /// @param lattice  make_lattice() of the springs, which each step changes; must outlive this
  /// @throws cases::InputError for biquadratic springs whose g and k differ
  SpringMemory(const cases::Scene& scene, const SpringBody& springs, Lattice& lattice);

  /// See mechanics::FadingMemory.  @param displacement  mm, one per point
  void begin(const Points& displacement) { memory_.begin(forces_at(displacement)); }
  void end_step(const Points& displacement, double length) {
    memory_.end_step(forces_at(displacement), length);
  }
  /// Gives the lattice the stiffnesses, and the forces beside them, of a step.
  void set_step(double duration);

 private:
  Lattice& lattice_;
  Lattice elastic_; ///< as it is in the end
  mechanics::FadingMemory memory_;

  /// Tensions and pressures of the terms in the end, in the order of the lattice.
  Vector forces_at(const Points& displacement) const;
};

} // namespace springproof::msm
