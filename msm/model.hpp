#pragma once

#include "cases/scene.hpp"
#include "cases/solution.hpp"
#include "msm/direct_system.hpp"

#include <memory>
#include <vector>

namespace msm {

/// A mass-spring model of a scene: its lattice, loads and supports, ready to be solved.
class Model {
 public:
  /// @param stiffness  one for every cell of the scene's mesh, or a single one for all
  Model(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness);

  /// Static equilibrium under the scene's loads.
  /// @param start  displacement (mm) to start from, one per node; empty: rest
  /// @throws cases::SolveError with the load reached and the outcome when the load cannot be carried
  cases::Solution solve(const EquilibriumSettings& settings = {}, const Points& start = {});

 private:
  std::unique_ptr<const Problem> problem_; ///< stays where it is when the model moves
  std::unique_ptr<EquilibriumSystem> system_;
};

} // namespace msm
