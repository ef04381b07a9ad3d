#include "msm/moving_body.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/scene.hpp"
#include "msm/direct/direct_system.hpp"
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

namespace {

/// Displacement when the motion begins, mm, one per point.
Points start_of(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options,
                const mechanics::IntegrationSettings& steps) {
  if (scene.definition.dynamics->start == cases::MotionStart::rest)
    return Points(scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  // What a step in real time may leave is no equilibrium.
  const auto settings = steps.enough_linear_iterations ? mechanics::EquilibriumSettings{} : steps.newton;
  return Model(cases::scene_before_start(scene), springs, options).solve(settings).displacement;
}

/// Volume of a body, mm³.  @param displacement  mm, one per node
double volume_of(const cases::HexMesh& mesh, const Points& displacement) {
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    sum += cases::cell_volume(cases::cell_vertices(mesh, c, displacement));
  return sum;
}

cases::Solution follow(const cases::Scene& scene, MovingBody& body, const Points& start,
                       const mechanics::IntegrationSettings& settings) {
  const auto points = [&](const Vector& state) { return body.to_points(state); };
  const mechanics::FollowedMotion followed = mechanics::follow_motion(
      scene,
      {body.motion(), points,
       [&](const Vector& state) { return volume_of(body.problem().mesh, points(state)); }},
      body.to_vector(start), settings);
  cases::Solution solution = solution_of(body.problem(), followed.work, points(followed.end));
  solution.trajectory = followed.trajectory;
  return solution;
}

} // namespace

cases::Solution follow(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options,
                       const mechanics::IntegrationSettings& settings) {
  ModelOptions directly = options;
  directly.path = Path::direct;
  MovingBody body(scene, springs, options);
  try {
    return follow(scene, body, start_of(scene, springs, body.is_on_grid() ? options : directly, settings),
                  settings);
  } catch (const cases::SolveError&) {
    const bool may_be_factorised =
        body.is_on_grid() && options.path == Path::automatic && scene.mesh.nodes.size() <= most_factorised;
    if (!may_be_factorised || !body.motion().has_failed()) throw;
  }
  return follow(scene, springs, directly, settings);
}

} // namespace springproof::msm
