#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "msm/lattice.hpp"

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

/// The cells of a mesh with a corner Jacobian <= 0.  @param displacement  mm, one per node
int n_inverted(const cases::HexMesh& mesh, const Points& displacement);

/// What an equilibrium and its displacement (mm, one per point) say of a problem.
cases::Solution solution_of(const Problem& problem, const mechanics::Equilibrium& equilibrium,
                            Points displacement);

} // namespace springproof::msm
