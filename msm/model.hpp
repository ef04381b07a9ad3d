#pragma once

#include "cases/case/solution.hpp"
#include "cases/mesh/cell_point.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/dynamics/follow_motion.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "msm/grid/grid_system.hpp"
#include "msm/grid/node_vectors.hpp"
#include "msm/moving_springs.hpp"
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

/// Whether a case on a grid with so many nodes, of springs that multigrid takes, is solved by it.
bool prefers_multigrid(const cases::Case& definition, const cases::Grid& grid, double n_nodes);

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

/// A scene's springs with what moves them, on the direct or on the multigrid path: a step at a time by a
/// mechanics::TimeIntegrator of motion().
class MovingBody {
 public:
  /// Takes the path that a Model of the springs would take, on the threads that the options give.
  MovingBody(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options = {});
  MovingBody(const MovingBody&) = delete; // its parts refer to each other
  MovingBody& operator=(const MovingBody&) = delete;

  MovingSprings& motion() { return *motion_; }
  const Problem& problem() const { return problem_; }
  bool is_on_grid() const { return grid_.has_value(); }

  /// Converts between the motion's vectors and one vector (mm, mm/s or N) per node of the scene's mesh.
  Vector to_vector(const Points& points) const;
  Points to_points(const Vector& vector) const;
  /// Returns one node's vector.
  Eigen::Vector3d at_node(const Vector& vector, int node) const;
  /// Takes hold of the weighted mean of some nodes, see MovingSprings::hold().
  /// @param stiffness  N/mm
  Pull& hold(const std::vector<cases::NodeWeight>& place, double stiffness);

 private:
  Problem problem_;
  std::optional<grid::GridProblem> grid_;
  std::optional<grid::NodeVectors> vectors_; ///< on the grid
  std::unique_ptr<SpringSystem> statics_;
  std::unique_ptr<MovingSprings> motion_;
  std::vector<std::array<Eigen::Index, 3>> entries_; ///< each node's places in a motion's vector; -1: none

  Eigen::Index size() const { return vectors_ ? vectors_->size() : statics_->load().size(); }
  void find_entries();
};

/// The motion of a scene's springs through the time of its [dynamics], on the path that a Model of them would
/// take; of the options, on which threads.
/// @return the end of the motion, with its trajectory
/// @throws cases::SolveError with the time reached when the motion cannot be followed, or with the load
/// reached when it cannot start in equilibrium
cases::Solution follow(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options = {},
                       const mechanics::IntegrationSettings& settings = {});

/// Stress, strain, energy and reactions of a body of springs in equilibrium under the scene's loads times a
/// factor, whichever solver has found it; where ranks share the solution, each rank's share. Collective.
///  - A cell has its part of the springs that it shares; see mechanics/field_sums.hpp for the stress. In a
///    lattice that is deformed affinely every cell has the stress of the infinite lattice, at the boundary
///    too; but where springs have at the boundary what they have inside (Boundary::whole), a cell there has
///    more of them than one inside, and a stress of its own.
///  - A network's springs belong to no cell: reactions, the whole energy and the cells' strain, without
///  stress
///    and energy of cells.
/// @param solution  its displacement is read
cases::Fields fields(const cases::Scene& scene, const SpringBody& springs, const cases::Solution& solution,
                     double load_factor = 1);

} // namespace springproof::msm
