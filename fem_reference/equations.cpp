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
  imbalance_ = has_right_hand_side_ ? evaluate_for_direction(at, load_factor)
                                    : evaluate(at, load_factor, Wanted::stress);
  if (!imbalance_.valid) return State::Constant(at.size(), std::numeric_limits<double>::quiet_NaN());
  State residual = State::Zero(at.size());
  const ReadEntries force(force_.get());
  for (std::size_t i = 0; i < discretisation_.load.size(); ++i)
    residual[static_cast<Eigen::Index>(i)] = -force[i];
  return residual;
}

EquilibriumEquations::Size EquilibriumEquations::size(const State&, const State&) {
  if (!imbalance_.valid) return {std::numeric_limits<double>::quiet_NaN(), false};
  return {imbalance_.residual,
          imbalance_.volume_mismatch <= volume_tolerance && imbalance_.prescribed_gap <= 1e-12};
}

std::optional<State> EquilibriumEquations::direction(const State& at, const State&, double load_factor,
                                                     double, mechanics::Convexity) {
  if (!has_right_hand_side_) imbalance_ = evaluate_for_direction(at, load_factor);
  has_right_hand_side_ = true;
  const auto solved = solver_.solve(right_hand_side_.get(), correction_.get(), n_tangents_);
  linear_iterations_ += solved.iterations;
  if (!solved.solved) return std::nullopt;
  mechanics::petsc::update_ghosts(correction_.get());
  State step = State::Zero(at.size());
  const ReadEntries correction(correction_.get());
  std::copy_n(correction.data(), n_dofs(), step.begin());
  assembly_.complete_correction(step);
  return step;
}

mechanics::Merit EquilibriumEquations::merit() const {
  const bool saddle_point = discretisation_.element.pressure == Pressure::modes;
  return saddle_point || is_linear() || imbalance_.prescribed_gap > 0 ? mechanics::Merit::none
                                                                      : mechanics::Merit::work;
}

std::optional<bool> EquilibriumEquations::is_stable(const State&) {
  negative_eigenvalues_ = solver_.negative_eigenvalues();
  return negative_eigenvalues_ ? std::optional(*negative_eigenvalues_ == 0) : std::nullopt;
}

EquilibriumEquations::Imbalance EquilibriumEquations::evaluate(const State& state, double load_factor,
                                                               Wanted wanted) {
  const auto& d = discretisation_;
  ++n_evaluations_;
  d.constraints.prescribe(load_factor, prescribed_gap_);
  for (std::size_t i = 0; i < prescribed_gap_.size(); ++i)
    prescribed_gap_[i] =
        d.constraints.is_constrained[i] ? prescribed_gap_[i] - state[static_cast<Eigen::Index>(i)] : 0;
  const auto cells = assembly_.assemble(state, prescribed_gap_, wanted, force_.get(), right_hand_side_.get());
  const Imbalance imbalance = measure(cells, load_factor);
  if (wanted == Wanted::stress) return imbalance;
  // minus the condensed imbalance, and the prescribed gap on constrained degrees of freedom
  const WriteEntries values(right_hand_side_.get());
  for (std::size_t i = 0; i < d.load.size(); ++i)
    values[i] = d.constraints.is_constrained[i] ? prescribed_gap_[i] : load_factor * d.load[i] - values[i];
  ++n_tangents_;
  has_tangent_ = imbalance.valid; // on all ranks alike
  return imbalance;
}

/// With the tangent and the right side; but a tangent that cannot have changed since it was last assembled, a
/// linear body's, is left as it is. The state's pressures are balanced: at rest or solved for.
EquilibriumEquations::Imbalance EquilibriumEquations::evaluate_for_direction(const State& state,
                                                                             double load_factor) {
  if (is_linear() && has_tangent_) {
    const Imbalance imbalance = evaluate(state, load_factor, Wanted::stress);
    if (imbalance.prescribed_gap == 0) { // supports that have to move ask the tangent for the forces of that
      assembly_.pressures_are_balanced();
      check(VecCopy(force_.get(), right_hand_side_.get()));
      check(VecScale(right_hand_side_.get(), -1));
      return imbalance;
    }
  }
  return evaluate(state, load_factor, Wanted::stress_and_tangent);
}

/// Subtracts the load from the internal force, which then is the imbalance, zero on constrained degrees of
/// freedom.
EquilibriumEquations::Imbalance EquilibriumEquations::measure(const Assembly::CellChecks& cells,
                                                              double load_factor) {
  const auto& d = discretisation_;
  Imbalance result;
  double imbalance = 0, reaction = 0, gap = 0;
  const WriteEntries force(force_.get());
  for (std::size_t i = 0; i < d.load.size(); ++i) {
    if (d.constraints.is_constrained[i]) {
      reaction += force[i] * force[i];
      gap = std::max(gap, std::abs(prescribed_gap_[i]));
      force[i] = 0;
    } else {
      force[i] -= load_factor * d.load[i];
      imbalance += force[i] * force[i];
    }
  }
  imbalance = std::sqrt(total(imbalance, MPI_SUM, communicator_));
  // a body moved by prescribed displacements alone is measured against its reactions
  const double scale = load_norm_ > 0 ? load_norm_ : std::sqrt(total(reaction, MPI_SUM, communicator_));
  result.residual = imbalance == 0 ? 0 : imbalance / scale;
  result.volume_mismatch = total(cells.volume_mismatch, MPI_MAX, communicator_);
  result.prescribed_gap = total(gap, MPI_MAX, communicator_);
  result.valid = total(cells.valid ? 1 : 0, MPI_MIN, communicator_) == 1 && std::isfinite(imbalance);
  return result;
}

} // namespace springproof::fem_reference
