#include "fem_reference/equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace springproof::fem_reference {

using mechanics::petsc::total;

EquilibriumEquations::EquilibriumEquations(const Discretisation& discretisation,
                                           const std::vector<Formulation>& formulations)
    : DistributedProblem(discretisation.communicator), discretisation_(discretisation),
      formulation_(formulations.front()), assembly_(discretisation, formulations),
      solver_(discretisation, assembly_.tangent(), formulation_.symmetry),
      force_(discretisation.make_vector()), right_hand_side_(discretisation.make_vector()),
      correction_(discretisation.make_vector()) {
  const auto& d = discretisation_;
  double squared = 0;
  for (std::size_t i = 0; i < d.load.size(); ++i)
    if (!d.constraints.is_constrained[i]) squared += d.load[i] * d.load[i];
  load_norm_ = std::sqrt(total(squared, MPI_SUM, communicator_));
}

State EquilibriumEquations::residual(const State& at, double load_factor, mechanics::Expect expect) {
  has_right_hand_side_ = expect == mechanics::Expect::direction;
  if (has_right_hand_side_)
    evaluate_for_direction(at, load_factor);
  else
    evaluate(at, load_factor, Wanted::stress);
  if (!std::isfinite(size_.relative)) return State::Constant(at.size(), size_.relative);
  State residual = State::Zero(at.size());
  const ReadEntries force(force_.get());
  for (std::size_t i = 0; i < discretisation_.load.size(); ++i)
    residual[static_cast<Eigen::Index>(i)] = -force[i];
  return residual;
}

std::optional<State> EquilibriumEquations::direction(const State& at, const State&, double load_factor,
                                                     double, mechanics::Convexity) {
  if (!has_right_hand_side_) evaluate_for_direction(at, load_factor);
  has_right_hand_side_ = true;
  if (!solver_.solve(right_hand_side_.get(), correction_.get(), n_tangents_)) return std::nullopt;
  mechanics::petsc::update_ghosts(correction_.get());
  State step = State::Zero(at.size());
  const ReadEntries correction(correction_.get());
  std::copy_n(correction.data(), n_dofs(), step.begin());
  assembly_.complete_correction(step);
  return step;
}

mechanics::Merit EquilibriumEquations::merit() const {
  const bool saddle_point = discretisation_.element.pressure == Pressure::modes;
  return saddle_point || is_linear() || largest_gap_ > 0 ? mechanics::Merit::none : mechanics::Merit::work;
}

std::optional<bool> EquilibriumEquations::is_stable(const State&) {
  negative_eigenvalues_ = solver_.negative_eigenvalues();
  return negative_eigenvalues_ ? std::optional(*negative_eigenvalues_ == 0) : std::nullopt;
}

void EquilibriumEquations::evaluate(const State& state, double load_factor, Wanted wanted) {
  const auto& d = discretisation_;
  ++n_evaluations_;
  d.constraints.prescribe(load_factor, prescribed_gap_);
  for (std::size_t i = 0; i < prescribed_gap_.size(); ++i)
    prescribed_gap_[i] =
        d.constraints.is_constrained[i] ? prescribed_gap_[i] - state[static_cast<Eigen::Index>(i)] : 0;
  measure(assembly_.assemble(state, prescribed_gap_, wanted, force_.get(), right_hand_side_.get()),
          load_factor);
  if (wanted == Wanted::stress) return;
  // minus the condensed imbalance, and the prescribed gap on constrained degrees of freedom
  const WriteEntries values(right_hand_side_.get());
  for (std::size_t i = 0; i < d.load.size(); ++i)
    values[i] = d.constraints.is_constrained[i] ? prescribed_gap_[i] : load_factor * d.load[i] - values[i];
  ++n_tangents_;
  has_tangent_ = std::isfinite(size_.relative); // on all ranks alike
}

/// With the tangent and the right side; but a tangent that cannot have changed since it was last assembled, a
/// linear body's, is left as it is. The state's pressures are balanced: at rest or solved for.
void EquilibriumEquations::evaluate_for_direction(const State& state, double load_factor) {
  if (is_linear() && has_tangent_) {
    evaluate(state, load_factor, Wanted::stress);
    if (largest_gap_ == 0) { // supports that have to move ask the tangent for the forces of that
      assembly_.pressures_are_balanced();
      check(VecCopy(force_.get(), right_hand_side_.get()));
      check(VecScale(right_hand_side_.get(), -1));
      return;
    }
  }
  evaluate(state, load_factor, Wanted::stress_and_tangent);
}

/// Subtracts the load from the internal force, which then is the imbalance, zero on constrained degrees of
/// freedom.
void EquilibriumEquations::measure(std::optional<double> volume_mismatch, double load_factor) {
  const auto& d = discretisation_;
  double imbalance = 0, reaction = 0;
  largest_gap_ = 0;
  const WriteEntries force(force_.get());
  for (std::size_t i = 0; i < d.load.size(); ++i) {
    if (d.constraints.is_constrained[i]) {
      reaction += force[i] * force[i];
      largest_gap_ = std::max(largest_gap_, std::abs(prescribed_gap_[i]));
      force[i] = 0;
    } else {
      force[i] -= load_factor * d.load[i];
      imbalance += force[i] * force[i];
    }
  }
  imbalance = std::sqrt(total(imbalance, MPI_SUM, communicator_));
  largest_gap_ = total(largest_gap_, MPI_MAX, communicator_);
  // a body moved by prescribed displacements alone is measured against its reactions
  const double scale = load_norm_ > 0 ? load_norm_ : std::sqrt(total(reaction, MPI_SUM, communicator_));
  size_.relative = imbalance == 0 ? 0 : imbalance / scale;
  size_.constraints_hold =
      total(volume_mismatch.value_or(0), MPI_MAX, communicator_) <= volume_tolerance && largest_gap_ <= 1e-12;
  if (total(volume_mismatch ? 1 : 0, MPI_MIN, communicator_) == 0 || !std::isfinite(imbalance))
    size_ = {std::numeric_limits<double>::quiet_NaN(), false};
}

} // namespace springproof::fem_reference
