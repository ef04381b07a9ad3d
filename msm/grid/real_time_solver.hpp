#pragma once

#include "mechanics/grid/krylov.hpp"
#include "msm/grid/consistent_masses.hpp"
#include "msm/grid/node_vectors.hpp"
#include "msm/grid/spring_levels.hpp"
#include "msm/moving_springs.hpp"

namespace springproof::msm::grid {

/// Conjugate gradients for the equation of a step in real time, in single precision: its few iterations leave
/// far more of the residual than rounding does. Stiffness is scaled and a right side divided by its norm, so
/// that both may be of any size.
class RealTimeSolver {
 public:
  /// @param vectors  the motion's, for the body; must outlive this
  /// @param scale    factor on stiffness, the same as in the cycles given to solve()
  /// @param damping  springs whose tangent at rest is damping by stiffness
  /// @param masses   consistent ones, which must outlive this; null: none
  RealTimeSolver(const Body& body, const NodeVectors& vectors, double scale,
                 const std::optional<Body>& damping, const CellMasses* masses, int n_threads);
  RealTimeSolver(const RealTimeSolver&) = delete; // its springs refer to its bodies

  /// @param diagonal       lumped mass and damping by mass in a step's equation, N/mm; 0 on constrained
  ///                       entries
  /// @param mass, damping  factors of M and C in it
  void set_step(const Vector& diagonal, double mass, double damping);
  /// Sets what pulls from now on.
  void set_pull(const std::optional<Pull>& pull);
  /// Sets what tools add.  @param blocks  N/mm times scale
  void set_blocks(std::vector<NodeBlock> blocks) { blocks_ = std::move(blocks); }
  /// Must be called when the cycle given to solve() has changed.
  void has_cycle_changed();

  /// solution = (tangent + damping + diagonal + pull)^-1 right_side, as far as it is asked for.
  /// @param at       displacement, mm
  /// @param size     norm of the right side
  /// @param forcing  residual to be left, relative to that
  /// @param cycle    approximate inverse, with the same scale and without the pull
  /// @return iterations and outcome, valid until the next call; the solution in it is scaled
  const mechanics::grid::LinearSolutionIn<float>& solve(const Vector& at, Clamp clamp,
                                                        const Vector& right_side, double size, double forcing,
                                                        int most_iterations, SpringLevels& cycle,
                                                        Vector& solution);

 private:
  const NodeVectors& vectors_;
  double scale_;
  int n_threads_;
  Body body_;
  std::optional<Body> damping_body_;
  SpringField<float> springs_;
  std::optional<SpringField<float>> damping_;
  std::optional<ConsistentMasses<float>> masses_;
  double mass_factor_ = 0, damping_factor_ = 0;
  std::vector<NodeBlock> blocks_;
  Field<float> diagonal_, at_, rest_, right_side_, damped_;
  mechanics::grid::KeptFields<float> kept_;
  mechanics::grid::LinearSolutionIn<float> found_;
  std::optional<Pull> pull_; ///< scaled, at entries of a field
  std::optional<WithPull<float>> with_pull_;

  void multiply(Clamp clamp, const Field<float>& direction, Field<float>& product);
};

} // namespace springproof::msm::grid
