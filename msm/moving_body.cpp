#include "msm/moving_body.hpp"

#include "msm/direct/direct_system.hpp"
#include "msm/direct/moving_lattice.hpp"
#include "msm/grid/moving_grid.hpp"

#include <cmath>
#include <utility>

namespace springproof::msm {

MovingBody::MovingBody(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options)
    : problem_(make_moving_problem(scene)) {
  const SpringBody damping = damping_springs(scene, springs);
  if (takes_multigrid(scene, springs, options.path)) {
    grid_ = grid::make_grid_problem(problem_, *springs.cells());
    vectors_.emplace(grid_->body);
    auto statics = grid::make_grid_system(*grid_, options.n_threads);
    motion_ = grid::make_moving_grid(problem_, *grid_, *vectors_, *statics, make_inertia(scene, {}),
                                     *damping.cells(), options.n_threads);
    statics_ = std::move(statics);
  } else {
    problem_.lattice = make_lattice(scene.mesh, springs);
    statics_ = make_direct_system(problem_);
    motion_ =
        make_moving_lattice(problem_, *statics_, make_inertia(scene, make_lattice(scene.mesh, damping)));
  }
  find_entries();
}

/// What the places of a vector become as points says where they are.
void MovingBody::find_entries() {
  const Vector places = Vector::LinSpaced(size(), 1, static_cast<double>(size()));
  Vector room;
  const Points at = grid_ ? grid::to_points(problem_, grid_->body, vectors_->to_field(places, room))
                          : msm::to_points(problem_, places);
  for (const Eigen::Vector3d& of_point : at) {
    entries_.emplace_back();
    for (int c = 0; c < 3; ++c) entries_.back()[cases::index(c)] = std::lround(of_point[c]) - 1;
  }
}

Vector MovingBody::to_vector(const Points& points) const {
  Vector vector = Vector::Zero(size());
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int c = 0; c < 3; ++c)
      if (const Eigen::Index entry = entries_[p][cases::index(c)]; entry >= 0) vector[entry] = points[p][c];
  return vector;
}

Eigen::Vector3d MovingBody::at_node(const Vector& vector, int node) const {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c)
    if (const Eigen::Index entry = entries_[cases::index(node)][cases::index(c)]; entry >= 0)
      value[c] = vector[entry];
  return value;
}

Points MovingBody::to_points(const Vector& vector) const {
  Points points;
  points.reserve(entries_.size());
  for (std::size_t node = 0; node < entries_.size(); ++node)
    points.push_back(at_node(vector, static_cast<int>(node)));
  return points;
}

Pull& MovingBody::hold(const std::vector<cases::NodeWeight>& place, double stiffness) {
  Pull::Entries entries;
  for (const auto& [node, weight] : place)
    for (std::size_t c = 0; c < 3; ++c)
      if (const Eigen::Index at = entries_[cases::index(node)][c]; at >= 0)
        entries[c].push_back({at, weight, !problem_.is_constrained[3 * cases::index(node) + c]});
  return motion_->hold({std::move(entries), stiffness});
}

} // namespace springproof::msm
