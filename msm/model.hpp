#pragma once

#include "cases/scene.hpp"
#include "cases/solution.hpp"
#include "msm/equilibrium.hpp"

#include <memory>
#include <vector>

namespace msm {

/// A mass-spring model of a scene: its lattice, loads and supports, with the tangent's pattern ordered.
class Model {
 public:
  /// @param stiffness  one for every cell of the scene's mesh, or a single one for all
  Model(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness);

  /// Static equilibrium under the scene's loads, from rest.
  /// @throws cases::SolveError with the load reached when the load cannot be carried
  cases::Solution solve();

 private:
  const cases::HexMesh mesh_;
  const Problem problem_;
  EquilibriumSolver solver_;
};

} // namespace msm
