#include "compare/measure/measure.hpp"

#include "cases/mesh/sharing.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace springproof::compare {

namespace {

using cases::index;
using Eigen::Vector3d;

constexpr double full_turn = 360;

/// The angle (degrees) that differs by whole turns from one, and is nearest to another.
double nearest(double degrees, double to) {
  return degrees + full_turn * std::round((to - degrees) / full_turn);
}

/// The turns of a segment by the cells at each node, counted from one of them to the next.
class TurnedNodes {
 public:
  TurnedNodes(const TurnedSegment& segment, const cases::Scene& scene,
              const std::vector<Vector3d>& displacement)
      : segment_(segment), mesh_(scene.mesh), turned_(mesh_.nodes.size(), Vector3d::Zero()),
        degrees_(mesh_.nodes.size(), 0), is_counted_(mesh_.nodes.size(), false) {
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
      const Vector3d turned = deformation_gradient(mesh_, c, displacement) * segment.along;
      for (const int node : mesh_.cells[c]) turned_[index(node)] += turned;
    }
    for (std::size_t n = 0; n < degrees_.size(); ++n) degrees_[n] = degrees_between(segment, turned_[n]);
  }

  /// Angle in (-180, 180].
  static double degrees_between(const TurnedSegment& segment, const Vector3d& turned) {
    const double x = segment.along[segment.from], y = segment.along[segment.towards];
    const double to_x = turned[segment.from], to_y = turned[segment.towards];
    return degrees_per_radian * std::atan2(x * to_y - y * to_x, x * to_x + y * to_y);
  }

  void begin_at(int node, double near) {
    if (!is_counted_[index(node)]) count(node, near);
  }
  bool has_begun() const { return !neighbours_.empty(); }

  /// Counts the turns of all nodes within reach, through the smallest differences first.
  void count_all() {
    while (!steps_.empty()) {
      const auto [size, from, to] = steps_.top();
      steps_.pop();
      if (!is_counted_[index(to)]) count(to, degrees_[index(from)]);
    }
  }
  std::optional<double> at(int node) const {
    return is_counted_[index(node)] ? std::optional(degrees_[index(node)]) : std::nullopt;
  }

 private:
  using Step = std::tuple<double, int, int>; ///< degrees from a node that is counted to another one

  const TurnedSegment& segment_;
  const cases::Mesh& mesh_;
  std::vector<Vector3d> turned_;
  std::vector<double> degrees_;
  std::vector<bool> is_counted_;
  std::vector<std::vector<int>> neighbours_;                           ///< by node, from the first count on
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps_; ///< the smallest first

  void count(int node, double near) {
    degrees_[index(node)] = nearest(degrees_[index(node)], near);
    is_counted_[index(node)] = true;
    if (neighbours_.empty()) find_neighbours();
    for (const int other : neighbours_[index(node)]) {
      if (is_counted_[index(other)]) continue;
      const double here = degrees_[index(node)];
      steps_.emplace(std::abs(nearest(degrees_[index(other)], here) - here), node, other);
    }
  }
  void find_neighbours() {
    neighbours_.resize(mesh_.nodes.size());
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      for (const auto& edge : cases::reference_cell(mesh_.shape).edges) {
        const auto [a, b] = cases::pick(mesh_.cells[c], edge);
        neighbours_[index(a)].push_back(b);
        neighbours_[index(b)].push_back(a);
      }
    for (std::vector<int>& of_node : neighbours_) cases::make_set(of_node);
  }
};

/// Whether a cell turns by more than a quarter: without one, no two neighbours differ by half a turn.
bool is_turned_far(const TurnedSegment& segment, const cases::Scene& scene,
                   const std::vector<Vector3d>& displacement, const cases::Sharing* sharing) {
  const cases::Share here = cases::share_here(scene.mesh, sharing);
  double largest = 0;
  for (std::size_t c = here.cells.begin; c < here.cells.end; ++c) {
    const Vector3d turned =
        deformation_gradient(scene.mesh, c, displacement, here.nodes.begin) * segment.along;
    largest = std::max(largest, std::abs(TurnedNodes::degrees_between(segment, turned)));
  }
  if (sharing) largest = sharing->largest(largest);
  return largest > full_turn / 4;
}

void begin_at_supports(TurnedNodes& nodes, const TurnedSegment& segment, const cases::Scene& scene,
                       const std::function<double(const cases::Moved&)>& factor) {
  const int across = 3 - segment.from - segment.towards;
  const double sign = (segment.from + 1) % 3 == segment.towards ? 1 : -1;
  for (const auto& [selection, motion] : scene.moved)
    for (const int node : selection.nodes) {
      if (motion.angle == 0) break;
      const double part = motion.scaled ? motion.scaled->factor(scene.mesh.nodes[index(node)]) : 1;
      nodes.begin_at(node, sign * motion.axis[across] * part * factor(motion) * motion.angle);
    }
  const std::vector<bool> is_held = cases::constrained_dofs(scene);
  for (const int n_held : {2, 1}) {
    if (nodes.has_begun() && n_held == 1) return;
    for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n)
      if (is_held[3 * n + index(segment.from)] + is_held[3 * n + index(segment.towards)] >= n_held)
        nodes.begin_at(static_cast<int>(n), 0);
  }
}

} // namespace

Eigen::Matrix3d deformation_gradient(const cases::Mesh& mesh, std::size_t cell,
                                     const std::vector<Vector3d>& displacement, std::size_t first_node) {
  const Vector3d centre = Vector3d::Constant(0.5); // a tetrahedron has one Jacobian everywhere
  return cases::jacobian(cases::cell_corners(mesh, cell, displacement, first_node), centre) *
         cases::jacobian(cases::cell_corners(mesh, cell), centre).inverse();
}

double count_turns(double degrees, const TurnedSegment& segment, const cases::Scene& scene,
                   const std::vector<Vector3d>& displacement, const cases::Sharing* sharing,
                   const std::function<double(const cases::Moved&)>& factor) {
  if (!is_turned_far(segment, scene, displacement, sharing)) return nearest(degrees, 0);
  TurnedNodes nodes(segment, scene, sharing ? sharing->gather(displacement) : displacement);
  begin_at_supports(nodes, segment, scene, factor);
  nodes.count_all();
  const auto first = nodes.at(segment.nodes[0]), second = nodes.at(segment.nodes[1]);
  return first && second ? nearest(degrees, (*first + *second) / 2) : nearest(degrees, 0);
}

void count_turns_in_time(std::vector<double>& degrees) {
  for (std::size_t i = 1; i < degrees.size(); ++i) degrees[i] = nearest(degrees[i], degrees[i - 1]);
}

} // namespace springproof::compare
