#pragma once

#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "msm/grid/grid_system.hpp"
#include "msm/spring_body.hpp"

namespace springproof::msm {

enum class Path {
  automatic, ///< multigrid on grids of cells from where it is the faster one; else, or where it fails at rest
             ///< as it does on slender bodies, direct
  direct,    ///< any mesh: assembled tangent, sparse factorisation
  multigrid  ///< grids of cells without negative springs: no matrix, conjugate gradients with a multigrid
             ///< cycle
};

/// Nodes from which the multigrid path was measured to be the faster one.
constexpr std::size_t multigrid_from = 500;

struct ModelOptions {
  Path path = Path::automatic;
  int n_threads = 1;           ///< used by the multigrid path; results do not depend on it
  grid::DealOut deal_out = {}; ///< division among ranks, on the multigrid path; then solve() is collective
  std::shared_ptr<const cases::Sharing> sharing = {}; ///< the ranks that get the answer together, then
};

/// Whether a grid with so many nodes, of springs that multigrid takes, is solved by it.
bool prefers_multigrid(const cases::Grid& grid, double n_nodes);

/// Whether the multigrid path is taken.
/// @throws cases::InputError when it is wanted and cannot be taken
bool takes_multigrid(const cases::Scene& scene, const SpringBody& springs, Path wanted = Path::automatic);

/// A mass-spring model of a scene: its lattice, loads and supports, ready to be solved.
class Model {
 public:
  /// @throws cases::InputError when the multigrid path is asked for and cannot be taken
  Model(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options = {});
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  /// Static equilibrium under the scene's loads; or, where [msm] gives force scaling a number of iterations,
  /// what they come to, with Solution::from_equilibrium but for the distances.
  /// @param start  displacement (mm) to start from, one per node; empty: rest
  /// @throws cases::SolveError with the load reached and the outcome when the load cannot be carried
  cases::Solution solve(const mechanics::EquilibriumSettings& settings = {}, const Points& start = {});

 private:
  cases::Solution solve_on_path(mechanics::EquilibriumSettings settings, const Points& start);

  cases::Solver solver_;
  std::optional<cases::RelaxationCounts> relaxation_; ///< set if force scaling gets a number of iterations
  double largest_turn_;                               ///< largest of the supports, degrees
  int least_steps_;                                   ///< least number of load steps
  int n_threads_;
  std::shared_ptr<const cases::Sharing> sharing_;
  std::optional<SpringBody> fallback_; ///< for the direct path, should multigrid fail
  Problem problem_;
  std::optional<grid::GridProblem> grid_; ///< on the multigrid path
  std::unique_ptr<SpringSystem> system_;
};

} // namespace springproof::msm
