#include "fem_reference/equations.hpp"

namespace springproof::fem_reference {

void Assembly::set_memory(const cases::Case& definition) {
  memory_.reset();
  if (!cases::has_memory(definition)) return;
  std::vector<mechanics::FadingMemory::Branch> branches;
  for (const auto& [tau, of_material] : mechanics::prony_branches(definition)) {
    mechanics::Vector part(discretisation_.nodes.n_cells * n_of_memory());
    for (Eigen::Index i = 0; i < part.size(); ++i) {
      const auto& own = of_material[material_of(static_cast<int>(i / n_of_memory()))];
      part[i] = i % CellMemory::n == CellMemory::pressure ? own.k : own.g;
    }
    branches.push_back({tau, std::move(part)});
  }
  memory_.emplace(branches);
}

CellMemory Assembly::memory_of(int cell) const {
  if (!memory_) return {};
  const auto first = static_cast<std::ptrdiff_t>(cell) * n_of_memory();
  return {memory_->factor().data() + first, memory_->remembered().data() + first};
}

mechanics::Vector Assembly::elastic_stresses(const State& state) {
  mechanics::Vector all(discretisation_.nodes.n_cells * n_of_memory());
  for_each_cell(state, [&](int cell, const CellGeometry& geometry, const double* at, const double* internal) {
    kernel(cell).elastic(geometry, at, internal,
                         all.data() + static_cast<std::ptrdiff_t>(cell) * n_of_memory());
  });
  return all;
}

} // namespace springproof::fem_reference
