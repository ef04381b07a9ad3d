#include "fem_reference/equilibrium.hpp"

#include "cases/case/index.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::fem_reference {

namespace {

using cases::index;

/// Read access to a ghosted vector's owned and ghost entries.
class LocalValues {
 public:
  explicit LocalValues(Vec vector) : vector_(vector) {
    check(VecGhostGetLocalForm(vector_, &local_));
    check(VecGetArrayRead(local_, &values_));
  }
  ~LocalValues() {
    VecRestoreArrayRead(local_, &values_);
    VecGhostRestoreLocalForm(vector_, &local_);
  }
  LocalValues(const LocalValues&) = delete;
  LocalValues& operator=(const LocalValues&) = delete;
  const double* data() const { return values_; }

 private:
  Vec vector_;
  Vec local_ = nullptr;
  const PetscScalar* values_ = nullptr;
};

void update_ghosts(Vec vector) {
  check(VecGhostUpdateBegin(vector, INSERT_VALUES, SCATTER_FORWARD));
  check(VecGhostUpdateEnd(vector, INSERT_VALUES, SCATTER_FORWARD));
}

/// Sum over ranks of contributions to owned and ghost entries.
void gather(const std::vector<double>& contributions, Vec sum) {
  Vec local = nullptr;
  PetscScalar* values = nullptr;
  check(VecGhostGetLocalForm(sum, &local));
  check(VecGetArray(local, &values));
  std::copy(contributions.begin(), contributions.end(), values);
  check(VecRestoreArray(local, &values));
  check(VecGhostRestoreLocalForm(sum, &local));
  check(VecGhostUpdateBegin(sum, ADD_VALUES, SCATTER_REVERSE));
  check(VecGhostUpdateEnd(sum, ADD_VALUES, SCATTER_REVERSE));
}

double total(double value, MPI_Op operation, MPI_Comm communicator) {
  double result = 0;
  MPI_Allreduce(&value, &result, 1, MPI_DOUBLE, operation, communicator);
  return result;
}

} // namespace

Equilibrium::Equilibrium(const Discretisation& discretisation, const std::vector<Formulation>& formulations)
    : discretisation_(discretisation), formulation_(formulations.front()),
      force_(discretisation.make_vector()), condensed_force_(discretisation.make_vector()),
      right_hand_side_(discretisation.make_vector()) {
  for (const Formulation& formulation : formulations)
    kernels_.emplace_back(discretisation.element, formulation);
  const auto& d = discretisation_;
  local_force_.resize(d.is_fixed.size());
  local_condensed_.resize(d.is_fixed.size());
  prescribed_gap_.resize(d.is_fixed.size());
  const auto n_pressures = index(d.n_cells) * index(d.element.n_pressure_modes);
  pressure_residual_.resize(n_pressures);
  volume_residual_.resize(n_pressures);
  pressure_slope_.resize(n_pressures * 3 * index(d.nodes_per_cell));

  double squared = 0;
  for (std::size_t i = 0; i < d.load.size(); ++i)
    if (!d.is_fixed[i]) squared += d.load[i] * d.load[i];
  load_norm_ = std::sqrt(total(squared, MPI_SUM, d.communicator));

  // A tangent's rows of a fixed degree of freedom are the identity's; what cells add to them is ignored.
  std::vector<PetscInt> global(d.node_point.size());
  for (std::size_t node = 0; node < global.size(); ++node)
    global[node] = node < index(d.n_owned_nodes) ? d.first_owned_node + static_cast<PetscInt>(node)
                                                 : d.ghost_nodes[node - index(d.n_owned_nodes)];
  ISLocalToGlobalMapping mapping = nullptr;
  check(ISLocalToGlobalMappingCreate(d.communicator, 3, static_cast<PetscInt>(global.size()), global.data(),
                                     PETSC_COPY_VALUES, &mapping));
  check(MatSetLocalToGlobalMapping(d.tangent, mapping, mapping));
  check(ISLocalToGlobalMappingDestroy(&mapping));
}

CellKernel& Equilibrium::kernel(int cell) {
  const std::vector<int>& material = discretisation_.material_of_cell;
  return kernels_[material.empty() ? 0 : index(material[index(cell)])];
}

State Equilibrium::rest() const {
  return {discretisation_.make_vector(), std::vector<double>(volume_residual_.size(), 0.)};
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

void Equilibrium::begin_assembly(const State& state, double load_factor) {
  std::fill(local_force_.begin(), local_force_.end(), 0.);
  std::fill(local_condensed_.begin(), local_condensed_.end(), 0.);
  largest_mismatch_ = 0;
  const LocalValues displacement(state.displacement.get());
  discretisation_.prescribe(load_factor, prescribed_gap_);
  for (std::size_t i = 0; i < prescribed_gap_.size(); ++i)
    prescribed_gap_[i] = discretisation_.is_fixed[i] ? prescribed_gap_[i] - displacement.data()[i] : 0;
}

bool Equilibrium::add_cell(int cell, const double* displacement, const State& state, Wanted wanted) {
  const auto& d = discretisation_;
  const auto n = index(d.nodes_per_cell), n_dofs = 3 * n, n_modes = index(d.element.n_pressure_modes);
  const int* nodes = d.cell_nodes.data() + index(cell) * n;
  thread_local std::vector<double> cell_displacement;
  thread_local std::vector<PetscInt> rows;
  cell_displacement.resize(n_dofs);
  rows.resize(n_dofs);
  bool has_gap = false;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t dof = 3 * index(nodes[a]) + i;
      cell_displacement[3 * a + i] = displacement[dof];
      rows[i * n + a] = d.is_fixed[dof] ? -1 : static_cast<PetscInt>(dof);
      has_gap = has_gap || prescribed_gap_[dof] != 0;
    }
  const CellResult& result = kernel(cell).evaluate(d.geometry(cell), cell_displacement.data(),
                                                   state.pressure.data() + index(cell) * n_modes, wanted);
  if (!result.valid) return false;
  largest_mismatch_ = std::max(largest_mismatch_, result.volume_mismatch);
  std::copy(result.volume_residual.begin(), result.volume_residual.end(),
            volume_residual_.begin() + static_cast<std::ptrdiff_t>(index(cell) * n_modes));
  for (std::size_t k = 0; k < n_dofs; ++k) {
    const std::size_t dof = 3 * index(nodes[k % n]) + k / n;
    local_force_[dof] += result.plain_force[k];
    local_condensed_[dof] += result.force[k];
    if (!has_gap || wanted == Wanted::stress) continue;
    for (std::size_t l = 0; l < n_dofs; ++l)
      local_condensed_[dof] +=
          result.tangent[k * n_dofs + l] * prescribed_gap_[3 * index(nodes[l % n]) + l / n];
  }
  if (wanted == Wanted::stress) return true;
  const auto size = static_cast<PetscInt>(n_dofs);
  check(
      MatSetValuesLocal(d.tangent, size, rows.data(), size, rows.data(), result.tangent.data(), ADD_VALUES));
  std::copy(result.pressure_residual.begin(), result.pressure_residual.end(),
            pressure_residual_.begin() + static_cast<std::ptrdiff_t>(index(cell) * n_modes));
  std::copy(result.pressure_slope.begin(), result.pressure_slope.end(),
            pressure_slope_.begin() + static_cast<std::ptrdiff_t>(index(cell) * n_modes * n_dofs));
  return true;
}

Imbalance Equilibrium::evaluate(const State& state, double load_factor, Wanted wanted) {
  const auto& d = discretisation_;
  ++n_evaluations_;
  begin_assembly(state, load_factor);
  if (wanted == Wanted::stress_and_tangent) check(MatZeroEntries(d.tangent));
  bool valid = true;
  {
    const LocalValues displacement(state.displacement.get());
    for (int cell = 0; cell < d.n_cells && valid; ++cell)
      valid = add_cell(cell, displacement.data(), state, wanted);
  }
  if (wanted == Wanted::stress_and_tangent) {
    check(MatAssemblyBegin(d.tangent, MAT_FLUSH_ASSEMBLY)); // adding gives way to inserting
    check(MatAssemblyEnd(d.tangent, MAT_FLUSH_ASSEMBLY));
    for (std::size_t i = 0; i < d.load.size(); ++i)
      if (d.is_fixed[i]) {
        const auto row = 3 * d.first_owned_node + static_cast<PetscInt>(i);
        check(MatSetValue(d.tangent, row, row, 1, INSERT_VALUES));
      }
    check(MatAssemblyBegin(d.tangent, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(d.tangent, MAT_FINAL_ASSEMBLY));
  }
  gather(local_force_, force_.get());
  if (wanted == Wanted::stress_and_tangent) {
    form_right_hand_side(load_factor);
    ++n_tangents_;
  }
  const Imbalance imbalance = measure(valid, load_factor);
  if (wanted == Wanted::stress_and_tangent) has_tangent_ = imbalance.valid; // on all ranks alike
  return imbalance;
}

Imbalance Equilibrium::evaluate_for_correction(const State& state, double load_factor) {
  if (formulation_.kinematics == Kinematics::linear && has_tangent_) {
    const Imbalance imbalance = evaluate(state, load_factor, Wanted::stress);
    if (imbalance.prescribed_gap == 0) { // supports that have to move ask the tangent for the forces of that
      std::fill(pressure_residual_.begin(), pressure_residual_.end(), 0.);
      form_right_hand_side(load_factor);
      return imbalance;
    }
  }
  return evaluate(state, load_factor, Wanted::stress_and_tangent);
}

/// Minus the condensed imbalance on free degrees of freedom, the prescribed gap on fixed ones.
void Equilibrium::form_right_hand_side(double load_factor) {
  const auto& d = discretisation_;
  gather(local_condensed_, condensed_force_.get());
  const LocalValues condensed(condensed_force_.get());
  PetscScalar* values = nullptr;
  check(VecGetArray(right_hand_side_.get(), &values));
  for (std::size_t i = 0; i < d.load.size(); ++i)
    values[i] = d.is_fixed[i] ? prescribed_gap_[i] : load_factor * d.load[i] - condensed.data()[i];
  check(VecRestoreArray(right_hand_side_.get(), &values));
}

/// Subtracts the load from the internal force, which then is the imbalance, zero on fixed degrees of freedom.
Imbalance Equilibrium::measure(bool valid, double load_factor) {
  const auto& d = discretisation_;
  Imbalance result;
  double imbalance = 0, reaction = 0, gap = 0;
  PetscScalar* force = nullptr;
  check(VecGetArray(force_.get(), &force));
  for (std::size_t i = 0; i < d.load.size(); ++i) {
    if (d.is_fixed[i]) {
      reaction += force[i] * force[i];
      gap = std::max(gap, std::abs(prescribed_gap_[i]));
      force[i] = 0;
    } else {
      force[i] -= load_factor * d.load[i];
      imbalance += force[i] * force[i];
    }
  }
  check(VecRestoreArray(force_.get(), &force));
  imbalance = std::sqrt(total(imbalance, MPI_SUM, d.communicator));
  // a body moved by prescribed displacements alone is measured against its reactions
  const double scale = load_norm_ > 0 ? load_norm_ : std::sqrt(total(reaction, MPI_SUM, d.communicator));
  result.residual = imbalance == 0 ? 0 : imbalance / scale;
  result.volume_mismatch = total(largest_mismatch_, MPI_MAX, d.communicator);
  result.prescribed_gap = total(gap, MPI_MAX, d.communicator);
  result.valid = total(valid ? 1 : 0, MPI_MIN, d.communicator) == 1 && std::isfinite(imbalance);
  return result;
}

void Equilibrium::complete_correction(State& correction) {
  const auto& d = discretisation_;
  update_ghosts(correction.displacement.get());
  const LocalValues displacement(correction.displacement.get());
  const auto n = index(d.nodes_per_cell), n_dofs = 3 * n, n_modes = index(d.element.n_pressure_modes);
  for (std::size_t m = 0; m < pressure_residual_.size(); ++m) {
    const int* nodes = d.cell_nodes.data() + m / n_modes * n;
    double change = pressure_residual_[m];
    for (std::size_t k = 0; k < n_dofs; ++k)
      change += pressure_slope_[m * n_dofs + k] * displacement.data()[3 * index(nodes[k % n]) + k / n];
    correction.pressure[m] = change;
  }
}

double Equilibrium::work(const State& correction) const {
  double displacement_work = 0, pressure_work = 0;
  check(VecDot(force_.get(), correction.displacement.get(), &displacement_work));
  for (std::size_t m = 0; m < volume_residual_.size(); ++m)
    pressure_work += volume_residual_[m] * correction.pressure[m];
  return displacement_work + total(pressure_work, MPI_SUM, discretisation_.communicator);
}

std::vector<double> Equilibrium::cell_volumes(const State& state) {
  const auto& d = discretisation_;
  std::vector<double> volumes;
  const LocalValues displacement(state.displacement.get());
  const auto n = index(d.nodes_per_cell);
  std::vector<double> cell_displacement(3 * n);
  const std::size_t n_modes = index(d.element.n_pressure_modes);
  for (int cell = 0; cell < d.n_cells; ++cell) {
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        cell_displacement[3 * a + i] = displacement.data()[3 * index(d.cell_nodes[index(cell) * n + a]) + i];
    volumes.push_back(kernel(cell)
                          .evaluate(d.geometry(cell), cell_displacement.data(),
                                    state.pressure.data() + index(cell) * n_modes, Wanted::stress)
                          .volume);
  }
  return volumes;
}

} // namespace springproof::fem_reference
