#include "fem_reference/equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace springproof::fem_reference {

using cases::index;
using mechanics::petsc::total;

Assembly::Assembly(const Discretisation& discretisation, const std::vector<Formulation>& formulations)
    : discretisation_(discretisation), kernels_(kernels_of(formulations, discretisation.element)),
      tangent_(discretisation.make_tangent_matrix()) {
  const ElementType& element = discretisation.element;
  const std::size_t n_dofs = 3 * index(discretisation.nodes.per_cell);
  n_internal_ = index(discretisation.nodes.n_cells) * index(element.n_internal());
  cell_displacement_.resize(n_dofs);
  rows_.resize(n_dofs);
  if (element.pressure == Pressure::nodes) {
    rows_.resize(n_dofs + index(element.n_pressure_modes));
    return;
  }
  internal_residual_.resize(n_internal());
  internal_slope_.resize(n_internal() * n_dofs);
}

std::size_t Assembly::unknown(int cell, std::size_t k) const {
  const auto n = index(discretisation_.nodes.per_cell);
  return index(discretisation_.nodes.of_cell[index(cell) * n + k % n]) * index(discretisation_.n_per_node()) +
         k / n;
}

std::size_t Assembly::material_of(int cell) const {
  const auto& material = discretisation_.material_of_cell;
  return material.empty() ? 0 : index(material[index(cell)]);
}

CellKernel& Assembly::kernel(int cell) const {
  return *kernels_[material_of(cell)];
}

const double* Assembly::internal(int cell, const State& state) const {
  return state.data() + n_displacements() + cell * discretisation_.element.n_internal();
}

const double* Assembly::displacement(int cell, const State& state) {
  const Nodes& nodes = discretisation_.nodes;
  const auto n = index(nodes.per_cell);
  for (std::size_t a = 0; a < n; ++a)
    std::copy_n(state.data() + 3 * nodes.of_cell[index(cell) * n + a], 3, cell_displacement_.data() + 3 * a);
  return cell_displacement_.data();
}

/// Rows and columns of constrained degrees of freedom are left out.
void Assembly::add_tangent(int cell, const CellResult& result, const std::vector<double>& gap,
                           const WriteEntries& condensed) {
  const std::size_t n_dofs = rows_.size();
  for (std::size_t k = 0; k < n_dofs; ++k) {
    rows_[k] = static_cast<PetscInt>(unknown(cell, k));
    condensed[index(rows_[k])] += result.force[k];
  }
  const auto n_per_node = static_cast<PetscInt>(discretisation_.n_per_node());
  for (std::size_t l = 0; l < cell_displacement_.size(); ++l) {
    const double change = gap[index(3 * (rows_[l] / n_per_node) + rows_[l] % n_per_node)];
    for (std::size_t k = 0; k < n_dofs && change != 0; ++k)
      condensed[index(rows_[k])] += result.tangent(k, l) * change;
  }
  for (PetscInt& row : rows_)
    if (discretisation_.is_held(index(row))) row = -1; // PETSc ignores it
  const auto size = static_cast<PetscInt>(n_dofs);
  check(MatSetValuesLocal(tangent(), size, rows_.data(), size, rows_.data(), result.tangent.data(),
                          ADD_VALUES));
  if (internal_residual_.empty()) return;
  const auto first = cell * discretisation_.element.n_internal();
  std::copy(result.internal_residual.begin(), result.internal_residual.end(),
            internal_residual_.begin() + first);
  std::copy_n(result.internal_slope.data(), result.internal_slope.size(),
              internal_slope_.begin() + first * size);
}

std::optional<InternalImbalance> Assembly::assemble(const State& state, const std::vector<double>& gap,
                                                    Wanted wanted, Vec force, Vec condensed) {
  const auto& d = discretisation_;
  const bool wants_tangent = wanted == Wanted::stress_and_tangent;
  std::optional<InternalImbalance> imbalance = InternalImbalance{};
  if (wants_tangent) {
    check(MatZeroEntries(tangent()));
    for (int i = 0; i < d.n_per_node() * d.nodes.n_owned; ++i)
      if (d.is_held(index(i))) check(MatSetValueLocal(tangent(), i, i, 1, ADD_VALUES));
  }
  {
    const WriteEntries plain(force), with_internals(condensed);
    const std::size_t n_unknowns = index(d.n_per_node()) * d.nodes.point.size();
    std::fill_n(plain.data(), n_unknowns, 0.);
    if (wants_tangent) std::fill_n(with_internals.data(), n_unknowns, 0.);
    for (int cell = 0; cell < d.nodes.n_cells; ++cell) {
      const CellResult& result = kernel(cell).evaluate(d.geometry.of(cell), displacement(cell, state),
                                                       internal(cell, state), wanted, memory_of(cell));
      if (!result.valid) {
        imbalance.reset();
        break;
      }
      imbalance->volume_mismatch = std::max(imbalance->volume_mismatch, result.volume_mismatch);
      imbalance->of_bubbles += result.bubble_imbalance;
      for (std::size_t k = 0; k < rows_.size(); ++k) plain[unknown(cell, k)] += result.plain_force[k];
      if (wants_tangent) add_tangent(cell, result, gap, with_internals);
    }
  }
  mechanics::petsc::add_ghosts(force);
  if (!wants_tangent) return imbalance;
  mechanics::petsc::add_ghosts(condensed);
  check(MatAssemblyBegin(tangent(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(tangent(), MAT_FINAL_ASSEMBLY));
  return imbalance;
}

void Assembly::complete_correction(State& correction) const {
  const std::size_t n_dofs = rows_.size(), n_modes = index(discretisation_.element.n_internal());
  for (std::size_t m = 0; m < internal_residual_.size(); ++m) {
    double change = internal_residual_[m];
    for (std::size_t k = 0; k < n_dofs; ++k)
      change +=
          internal_slope_[m * n_dofs + k] * correction.data()[unknown(static_cast<int>(m / n_modes), k)];
    correction.data()[n_displacements() + m] = change;
  }
}

void Assembly::set_pressures(const ReadEntries& unknowns, State& correction) const {
  const Nodes& nodes = discretisation_.nodes;
  const int n_modes = discretisation_.element.n_pressure_modes;
  double* pressure = correction.data() + n_displacements();
  for (int cell = 0; cell < nodes.n_cells; ++cell)
    for (int m = 0; m < n_modes; ++m)
      *pressure++ = unknowns[discretisation_.pressure_of(nodes.of_cell[index(cell * nodes.per_cell + m)])];
}

void Assembly::internals_are_balanced() {
  std::fill(internal_residual_.begin(), internal_residual_.end(), 0.);
}

EquilibriumEquations::EquilibriumEquations(const Discretisation& discretisation,
                                           const std::vector<Formulation>& formulations)
    : DistributedProblem(discretisation.communicator, discretisation.element.n_internal() > 0,
                         formulations.front().kinematics == Kinematics::linear &&
                             discretisation.tool_sides.empty()),
      discretisation_(discretisation), assembly_(discretisation, formulations),
      solver_(discretisation, assembly_.tangent(), formulations.front().symmetry),
      force_(discretisation.make_vector()), right_hand_side_(discretisation.make_vector()),
      correction_(discretisation.make_vector()), inertia_force_(discretisation.make_vector()) {
  const auto& d = discretisation_;
  double squared = 0;
  for (std::size_t i = 0; i < d.load.size(); ++i)
    if (!d.constraints.is_constrained[i]) squared += d.load[i] * d.load[i];
  load_norm_ = std::sqrt(total(squared, MPI_SUM, communicator_));
  if (!d.tool_sides.empty()) contact_.emplace(d.tool_sides);
}

void EquilibriumEquations::residual(const State& at, double load_factor, mechanics::Expect expect,
                                    State& residual) {
  has_right_hand_side_ = expect == mechanics::Expect::direction;
  if (has_right_hand_side_)
    evaluate_for_direction(at, load_factor);
  else
    evaluate(at, load_factor, Wanted::stress);
  residual.setConstant(at.size(), std::isfinite(size_.relative) ? 0 : size_.relative);
  if (!std::isfinite(size_.relative)) return;
  const ReadEntries force(force_.get());
  for (std::size_t i = 0; i < discretisation_.load.size(); ++i)
    residual[static_cast<Eigen::Index>(i)] = -force[discretisation_.unknown(i)];
}

bool EquilibriumEquations::direction(const State& at, const State&, double load_factor, double,
                                     mechanics::Convexity, State& step) {
  if (!has_right_hand_side_) evaluate_for_direction(at, load_factor);
  has_right_hand_side_ = true;
  if (!solver_.solve(right_hand_side_.get(), correction_.get(), n_tangents_)) return false;
  mechanics::petsc::update_ghosts(correction_.get());
  step.setZero(at.size());
  const ReadEntries correction(correction_.get());
  for (std::size_t i = 0; i < n_dofs(); ++i)
    step[static_cast<Eigen::Index>(i)] = correction[discretisation_.unknown(i)];
  if (has_nodal_pressures())
    assembly_.set_pressures(correction, step);
  else
    assembly_.complete_correction(step);
  return true;
}

std::optional<bool> EquilibriumEquations::is_stable(const State&) {
  negative_eigenvalues_ = solver_.negative_eigenvalues();
  return negative_eigenvalues_ ? std::optional(*negative_eigenvalues_ == 0) : std::nullopt;
}

void EquilibriumEquations::evaluate(const State& state, double load_factor, Wanted wanted) {
  const auto& d = discretisation_;
  ++n_evaluations_;
  d.constraints.prescribe(load_factor, prescribed_gap_);
  for (std::size_t i = 0; i < prescribed_gap_.size(); ++i) {
    const auto dof = static_cast<Eigen::Index>(i);
    if (step_) prescribed_gap_[i] = step_->supports[dof];
    prescribed_gap_[i] = d.constraints.is_constrained[i] ? prescribed_gap_[i] - state[dof] : 0;
  }
  const auto internal =
      assembly_.assemble(state, prescribed_gap_, wanted, force_.get(), right_hand_side_.get());
  if (step_) add_inertia(state, wanted);
  if (contact_) add_contact(state, step_ ? step_->time : load_factor, wanted);
  measure(internal, load_factor);
  if (wanted == Wanted::stress) return;
  // minus the condensed imbalance, and the prescribed gap on constrained degrees of freedom
  const WriteEntries values(right_hand_side_.get());
  for (std::size_t i = 0; i < d.load.size(); ++i) {
    double& value = values[d.unknown(i)];
    value = d.constraints.is_constrained[i] ? prescribed_gap_[i] : load(i, load_factor) - value;
  }
  for (const auto& pressure : d.pressures) values[d.pressure_of(pressure.first)] *= -1;
  ++n_tangents_;
  has_tangent_ = std::isfinite(size_.relative); // on all ranks alike
}

void EquilibriumEquations::set_in_motion(const cases::Scene& scene,
                                         const std::vector<Formulation>& formulations) {
  const auto& d = discretisation_;
  motion_.emplace(Motion{make_inertia(scene, d, formulations), {}});
  assembly_.set_memory(scene.definition);
  set_loads(scene, [&](const cases::Scene& alone) {
    const std::vector<double> load = d.load_of(alone);
    State force = rest();
    for (std::size_t i = 0; i < load.size(); ++i)
      if (!d.constraints.is_constrained[i]) force[static_cast<Eigen::Index>(i)] = load[i];
    return force;
  });
  motion_->added = 0. * motion_->inertia.mass + 0. * motion_->inertia.damping; // the pattern of every step
}

void EquilibriumEquations::supports_at(double time, State& displacement) const {
  const auto& constraints = discretisation_.constraints;
  std::vector<double> prescribed;
  constraints.prescribe_at(time, prescribed);
  for (std::size_t i = 0; i < prescribed.size(); ++i)
    if (constraints.is_constrained[i]) displacement[static_cast<Eigen::Index>(i)] = prescribed[i];
}

void EquilibriumEquations::set_step(const mechanics::StepTerms& terms) {
  const bool is_another = !step_ || terms.mass != step_->mass || terms.damping != step_->damping ||
                          (assembly_.memory() && terms.duration != step_->duration);
  step_.emplace(terms);
  if (assembly_.memory()) assembly_.memory()->set_step(terms.duration);
  if (!is_another) return;
  motion_->added = terms.mass * motion_->inertia.mass + terms.damping * motion_->inertia.damping;
  has_tangent_ = false;
}

/// Sets unknowns to displacements or forces.
void EquilibriumEquations::write(const State& from, Vec to) const {
  const WriteEntries entries(to);
  for (Eigen::Index i = 0; i < from.size(); ++i) entries[discretisation_.unknown(index(i))] = from[i];
}

/// Returns a motion's degrees of freedom, those of other ranks brought up to date.
State EquilibriumEquations::with_ghosts(const State& motion) {
  const auto n = static_cast<Eigen::Index>(n_dofs());
  write(motion.head(n), correction_.get());
  mechanics::petsc::update_ghosts(correction_.get());
  const ReadEntries all(correction_.get());
  State found(n);
  for (Eigen::Index i = 0; i < n; ++i) found[i] = all[discretisation_.unknown(index(i))];
  return found;
}

/// Sets inertia_force_ to a matrix, which all ranks add to, times a motion with current ghosts.
void EquilibriumEquations::set_inertia_force(const LocalMatrix& matrix, const State& motion) {
  write(matrix * motion, inertia_force_.get());
  mechanics::petsc::add_ghosts(inertia_force_.get());
}

/// Multiplies on free degrees of freedom of this rank; the product is 0 elsewhere.
void EquilibriumEquations::multiply(const LocalMatrix& matrix, const State& motion, State& product) {
  set_inertia_force(matrix, with_ghosts(motion));
  product.setZero(motion.size());
  const ReadEntries of_all(inertia_force_.get());
  for (int i = 0; i < 3 * discretisation_.nodes.n_owned; ++i)
    if (!discretisation_.constraints.is_constrained[index(i)])
      product[i] = of_all[discretisation_.unknown(index(i))];
}

void EquilibriumEquations::complete(State& motion) {
  motion.head(static_cast<Eigen::Index>(n_dofs())) = with_ghosts(motion);
  // Steps solve for pressures of nodes, whatever they begin with.
  if (!is_linear_ || assembly_.n_internal() == 0 || has_nodal_pressures()) return;
  if (!has_tangent_) evaluate(rest(), 0, Wanted::stress_and_tangent);
  assembly_.internals_are_balanced();
  assembly_.complete_correction(motion);
}

/// Load on a degree of freedom of this rank, N.
double EquilibriumEquations::load(std::size_t dof, double load_factor) const {
  return step_ ? step_->force[static_cast<Eigen::Index>(dof)] : load_factor * discretisation_.load[dof];
}

/// Adds the step's inertia and damping to the internal force. If a tangent is wanted, adds them to it and to
/// the right side as well, there with the part that the gap will add.
void EquilibriumEquations::add_inertia(const State& state, Wanted wanted) {
  const auto n = static_cast<Eigen::Index>(n_dofs());
  const auto add = [&](const State& way, Vec to) {
    set_inertia_force(motion_->added, way);
    const ReadEntries product(inertia_force_.get());
    const WriteEntries sum(to);
    for (std::size_t i = 0; i < discretisation_.load.size(); ++i)
      sum[discretisation_.unknown(i)] += product[discretisation_.unknown(i)];
  };
  State way = state.head(n) - step_->origin.head(n);
  add(way, force_.get());
  if (wanted == Wanted::stress) return;
  way += Eigen::Map<const State>(prescribed_gap_.data(), n);
  add(way, right_hand_side_.get());
  add_to_tangent(motion_->added);
}

/// Rows and columns of constrained degrees of freedom are left out.
void EquilibriumEquations::add_to_tangent(const LocalMatrix& added) {
  const auto& is_constrained = discretisation_.constraints.is_constrained;
  std::vector<PetscInt> columns;
  std::vector<PetscScalar> values;
  const auto unknown = [this](Eigen::Index dof) {
    return static_cast<PetscInt>(discretisation_.unknown(index(dof)));
  };
  for (Eigen::Index row = 0; row < added.rows(); ++row) {
    if (is_constrained[index(row)]) continue;
    columns.clear();
    values.clear();
    for (LocalMatrix::InnerIterator entry(added, row); entry; ++entry) {
      if (is_constrained[index(entry.col())]) continue;
      columns.push_back(unknown(entry.col()));
      values.push_back(entry.value());
    }
    const PetscInt in_tangent = unknown(row);
    check(MatSetValuesLocal(assembly_.tangent(), 1, &in_tangent, static_cast<PetscInt>(columns.size()),
                            columns.data(), values.data(), ADD_VALUES));
  }
  check(MatAssemblyBegin(assembly_.tangent(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(assembly_.tangent(), MAT_FINAL_ASSEMBLY));
}

/// Evaluates with the tangent and the right side. A linear body's tangent, once assembled, is left as it is:
/// it cannot have changed. The state's pressures are balanced: at rest or solved for.
void EquilibriumEquations::evaluate_for_direction(const State& state, double load_factor) {
  if (is_linear_ && has_tangent_) {
    evaluate(state, load_factor, Wanted::stress);
    // The tangent is needed for the forces of supports that have to move; supports that a step in time has
    // moved leave pressures of cells behind.
    if (largest_gap_ == 0 && (!step_ || has_nodal_pressures() || size_.constraints_hold)) {
      assembly_.internals_are_balanced();
      check(VecCopy(force_.get(), right_hand_side_.get()));
      check(VecScale(right_hand_side_.get(), -1));
      return;
    }
  }
  evaluate(state, load_factor, Wanted::stress_and_tangent);
}

/// Subtracts the load from the internal force, which then is the imbalance, zero on constrained degrees of
/// freedom.
void EquilibriumEquations::measure(const std::optional<InternalImbalance>& internal, double load_factor) {
  const auto& d = discretisation_;
  double imbalance = internal ? internal->of_bubbles : 0, reaction = 0,
         mismatch = internal ? internal->volume_mismatch : 0;
  largest_gap_ = 0;
  const WriteEntries force(force_.get());
  for (std::size_t i = 0; i < d.load.size(); ++i) {
    double& here = force[d.unknown(i)];
    if (d.constraints.is_constrained[i]) {
      reaction += here * here;
      largest_gap_ = std::max(largest_gap_, std::abs(prescribed_gap_[i]));
      here = 0;
    } else {
      here -= load(i, load_factor);
      imbalance += here * here;
    }
  }
  for (const auto& [node, volume] : d.pressures)
    mismatch = std::max(mismatch, std::abs(force[d.pressure_of(node)]) / volume);
  imbalance = std::sqrt(total(imbalance, MPI_SUM, communicator_));
  largest_gap_ = total(largest_gap_, MPI_MAX, communicator_);
  reaction = std::hypot(std::sqrt(total(reaction, MPI_SUM, communicator_)), contact_force_);
  double relative_to = scale(d.constraints.are_moved, reaction);
  if (step_) relative_to = std::max({relative_to, largest_contact_force_, contact_force_});
  size_.relative = imbalance == 0 ? 0 : imbalance / relative_to;
  mismatch = total(mismatch, MPI_MAX, communicator_);
  size_.constraints_hold = mismatch <= volume_tolerance && largest_gap_ <= 1e-12;
  if (total(internal ? 1 : 0, MPI_MIN, communicator_) == 0 || !std::isfinite(imbalance))
    size_ = {std::numeric_limits<double>::quiet_NaN(), false};
}

} // namespace springproof::fem_reference
