#include "fem_reference/assembly.hpp"

#include <algorithm>

namespace springproof::fem_reference {

using cases::index;

Assembly::Assembly(const Discretisation& discretisation, const std::vector<Formulation>& formulations)
    : discretisation_(discretisation), tangent_(discretisation.make_tangent_matrix()) {
  for (const Formulation& formulation : formulations)
    kernels_.push_back(formulation.make_kernel(discretisation.element));
  const std::size_t n_dofs = 3 * index(discretisation.nodes.per_cell);
  pressure_residual_.resize(index(discretisation.nodes.n_cells) *
                            index(discretisation.element.n_pressure_modes));
  pressure_slope_.resize(n_pressures() * n_dofs);
  cell_displacement_.resize(n_dofs);
  rows_.resize(n_dofs);
}

std::size_t Assembly::dof(int cell, std::size_t k) const {
  const auto n = index(discretisation_.nodes.per_cell);
  return 3 * index(discretisation_.nodes.of_cell[index(cell) * n + k % n]) + k / n;
}

CellKernel& Assembly::kernel(int cell) const {
  const auto& material = discretisation_.material_of_cell;
  return *kernels_[material.empty() ? 0 : index(material[index(cell)])];
}

const double* Assembly::pressure(int cell, const State& state) const {
  return state.data() + n_displacements() + cell * discretisation_.element.n_pressure_modes;
}

const double* Assembly::displacement(int cell, const State& state) {
  const Nodes& nodes = discretisation_.nodes;
  const auto n = index(nodes.per_cell);
  for (std::size_t a = 0; a < n; ++a)
    std::copy_n(state.data() + 3 * nodes.of_cell[index(cell) * n + a], 3, cell_displacement_.data() + 3 * a);
  return cell_displacement_.data();
}

const CellResult& Assembly::evaluate(int cell, const State& state, Wanted wanted) {
  return kernel(cell).evaluate(discretisation_.geometry.of(cell), displacement(cell, state),
                               pressure(cell, state), wanted);
}

/// Rows and columns of constrained degrees of freedom are left out.
void Assembly::add_tangent(int cell, const CellResult& result, const std::vector<double>& gap,
                           const WriteEntries& condensed) {
  const std::size_t n_dofs = rows_.size();
  for (std::size_t k = 0; k < n_dofs; ++k) {
    rows_[k] = static_cast<PetscInt>(dof(cell, k));
    condensed[index(rows_[k])] += result.force[k];
  }
  for (std::size_t l = 0; l < n_dofs; ++l) {
    const double change = gap[index(rows_[l])];
    for (std::size_t k = 0; k < n_dofs && change != 0; ++k)
      condensed[index(rows_[k])] += result.tangent(k, l) * change;
  }
  for (PetscInt& row : rows_)
    if (discretisation_.constraints.is_constrained[index(row)]) row = -1; // PETSc ignores it
  const auto size = static_cast<PetscInt>(n_dofs);
  check(MatSetValuesLocal(tangent(), size, rows_.data(), size, rows_.data(), result.tangent.data(),
                          ADD_VALUES));
  const auto first = cell * discretisation_.element.n_pressure_modes;
  std::copy(result.pressure_residual.begin(), result.pressure_residual.end(),
            pressure_residual_.begin() + first);
  std::copy_n(result.pressure_slope.data(), result.pressure_slope.size(),
              pressure_slope_.begin() + first * size);
}

std::optional<double> Assembly::assemble(const State& state, const std::vector<double>& gap, Wanted wanted,
                                         Vec force, Vec condensed) {
  const auto& d = discretisation_;
  const bool wants_tangent = wanted == Wanted::stress_and_tangent;
  std::optional<double> volume_mismatch = 0;
  if (wants_tangent) {
    check(MatZeroEntries(tangent()));
    for (int i = 0; i < 3 * d.nodes.n_owned; ++i)
      if (d.constraints.is_constrained[index(i)]) check(MatSetValueLocal(tangent(), i, i, 1, ADD_VALUES));
  }
  {
    const WriteEntries plain(force), with_pressures(condensed);
    std::fill_n(plain.data(), n_displacements(), 0.);
    if (wants_tangent) std::fill_n(with_pressures.data(), n_displacements(), 0.);
    for (int cell = 0; cell < d.nodes.n_cells; ++cell) {
      const CellResult& result = evaluate(cell, state, wanted);
      if (!result.valid) {
        volume_mismatch.reset();
        break;
      }
      *volume_mismatch = std::max(*volume_mismatch, result.volume_mismatch);
      for (std::size_t k = 0; k < rows_.size(); ++k) plain[dof(cell, k)] += result.plain_force[k];
      if (wants_tangent) add_tangent(cell, result, gap, with_pressures);
    }
  }
  mechanics::petsc::add_ghosts(force);
  if (!wants_tangent) return volume_mismatch;
  mechanics::petsc::add_ghosts(condensed);
  check(MatAssemblyBegin(tangent(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(tangent(), MAT_FINAL_ASSEMBLY));
  return volume_mismatch;
}

void Assembly::complete_correction(State& correction) const {
  const std::size_t n_dofs = rows_.size(), n_modes = index(discretisation_.element.n_pressure_modes);
  for (std::size_t m = 0; m < n_pressures(); ++m) {
    double change = pressure_residual_[m];
    for (std::size_t k = 0; k < n_dofs; ++k)
      change += pressure_slope_[m * n_dofs + k] * correction.data()[dof(static_cast<int>(m / n_modes), k)];
    correction.data()[n_displacements() + m] = change;
  }
}

void Assembly::pressures_are_balanced() {
  std::fill(pressure_residual_.begin(), pressure_residual_.end(), 0.);
}

std::vector<double> Assembly::cell_volumes(const State& state) {
  std::vector<double> volumes;
  for (int cell = 0; cell < discretisation_.nodes.n_cells; ++cell)
    volumes.push_back(
        CellKernel::deformed_volume(discretisation_.geometry.of(cell), displacement(cell, state)));
  return volumes;
}

void Assembly::add_norms(const State& state, DisplacementNorms& norms) {
  for (int cell = 0; cell < discretisation_.nodes.n_cells; ++cell)
    norms.add(discretisation_.geometry.of(cell), displacement(cell, state));
}

void Assembly::add_fields(const State& state, int n_refinements, ElementFields& fields) {
  const auto& d = discretisation_;
  for (int cell = 0; cell < d.nodes.n_cells; ++cell) {
    const CellResult& result = evaluate(cell, state, Wanted::stress);
    const CellGeometry geometry = d.geometry.of(cell);
    const double* displacement = cell_displacement_.data();
    fields.add({place_of(index(d.nodes.mesh_cell[index(cell)]), n_refinements), geometry, displacement,
                result.plain_force.data(),
                kernel(cell).energy(geometry, displacement, pressure(cell, state))});
  }
}

} // namespace springproof::fem_reference
