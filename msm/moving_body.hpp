#pragma once

#include "cases/mesh/cell_point.hpp"
#include "mechanics/dynamics/follow_motion.hpp"
#include "msm/grid/grid_system.hpp"
#include "msm/grid/node_vectors.hpp"
#include "msm/model.hpp"
#include "msm/moving_springs.hpp"

namespace springproof::msm {

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

} // namespace springproof::msm
