#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "msm/lattice.hpp"

#include <functional>
#include <vector>

namespace springproof::msm {

/// A supported and loaded lattice.
struct Problem {
  cases::HexMesh mesh;
  Lattice lattice;
  Points force;                     ///< applied at full load, N, one per point
  std::vector<bool> is_constrained; ///< constrained degrees of freedom: 3*point + component
  /// Displacement (mm) of constrained points at a load factor, one per point; empty: they stay at rest.
  std::function<Points(double load_factor)> supports{};
};

/// A scene as springs see it, but for its lattice.
Problem make_problem(const cases::Scene& scene);

/// Fills in what a solution's displacement says of the mesh's cells: deformed volumes, and how many are
/// inverted.
void measure_cells(const cases::HexMesh& mesh, cases::Solution& solution);

} // namespace springproof::msm
