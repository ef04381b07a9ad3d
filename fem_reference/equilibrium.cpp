#include "fem_reference/equilibrium.hpp"

#include "cases/case/index.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::fem_reference {

Equilibrium::Equilibrium(const Discretisation& discretisation, const std::vector<Formulation>& formulations)
    : discretisation_(discretisation), formulation_(formulations.front()),
      assembly_(discretisation, formulations), force_(discretisation.make_vector()),
      right_hand_side_(discretisation.make_vector()) {
  const auto& d = discretisation_;
  double squared = 0;
  for (std::size_t i = 0; i < d.load.size(); ++i)
    if (!d.constraints.is_constrained[i]) squared += d.load[i] * d.load[i];
  load_norm_ = std::sqrt(total(squared, MPI_SUM));
}

double Equilibrium::total(double value, MPI_Op operation) const {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, operation, discretisation_.communicator);
  return value;
}

State Equilibrium::rest() const {
  return {discretisation_.make_vector(), std::vector<double>(assembly_.n_pressures(), 0.)};
}

void Equilibrium::copy(const State& from, State& to) const {
  check(VecCopy(from.displacement.get(), to.displacement.get()));
  update_ghosts(to.displacement.get());
  to.pressure = from.pressure;
}

void Equilibrium::advance(State& to, double factor, const State& direction) const {
  check(VecAXPY(to.displacement.get(), factor, direction.displacement.get()));
  update_ghosts(to.displacement.get());
  for (std::size_t p = 0; p < to.pressure.size(); ++p) to.pressure[p] += factor * direction.pressure[p];
}

Imbalance Equilibrium::evaluate(const State& state, double load_factor, Wanted wanted) {
  const auto& d = discretisation_;
  ++n_evaluations_;
  d.constraints.prescribe(load_factor, prescribed_gap_);
  {
    const LocalForm displacement(state.displacement.get());
    for (std::size_t i = 0; i < prescribed_gap_.size(); ++i)
      prescribed_gap_[i] = d.constraints.is_constrained[i] ? prescribed_gap_[i] - displacement[i] : 0;
  }
  const auto cells = assembly_.assemble(state, prescribed_gap_, wanted, force_.get(), right_hand_side_.get());
  const Imbalance imbalance = measure(cells, load_factor);
  if (wanted == Wanted::stress) return imbalance;
  // minus the condensed imbalance, and the prescribed gap on constrained degrees of freedom
  const LocalForm values(right_hand_side_.get());
  for (std::size_t i = 0; i < d.load.size(); ++i)
    values[i] = d.constraints.is_constrained[i] ? prescribed_gap_[i] : load_factor * d.load[i] - values[i];
  ++n_tangents_;
  has_tangent_ = imbalance.valid; // on all ranks alike
  return imbalance;
}

Imbalance Equilibrium::evaluate_for_correction(const State& state, double load_factor) {
  if (formulation_.kinematics == Kinematics::linear && has_tangent_) {
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
Imbalance Equilibrium::measure(const Assembly::CellChecks& cells, double load_factor) {
  const auto& d = discretisation_;
  Imbalance result;
  double imbalance = 0, reaction = 0, gap = 0;
  {
    const LocalForm force(force_.get());
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
  }
  imbalance = std::sqrt(total(imbalance, MPI_SUM));
  // a body moved by prescribed displacements alone is measured against its reactions
  const double scale = load_norm_ > 0 ? load_norm_ : std::sqrt(total(reaction, MPI_SUM));
  result.residual = imbalance == 0 ? 0 : imbalance / scale;
  result.volume_mismatch = total(cells.volume_mismatch, MPI_MAX);
  result.prescribed_gap = total(gap, MPI_MAX);
  result.valid = total(cells.valid ? 1 : 0, MPI_MIN) == 1 && std::isfinite(imbalance);
  return result;
}

void Equilibrium::complete_correction(State& correction) {
  update_ghosts(correction.displacement.get());
  assembly_.complete_correction(correction);
}

double Equilibrium::work(const State& correction) const {
  double displacement_work = 0;
  check(VecDot(force_.get(), correction.displacement.get(), &displacement_work));
  return displacement_work + total(assembly_.pressure_work(correction), MPI_SUM);
}

} // namespace springproof::fem_reference
