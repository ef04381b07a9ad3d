#include "compare/measure.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

namespace compare {

using cases::MeasureKind;
using Eigen::Vector3d;

namespace {

constexpr double degrees_per_radian = 57.295779513082320877;

struct Configuration {
  const cases::Scene& scene;
  const cases::Solution& solution;
  Vector3d rest(int node) const { return scene.mesh.nodes[static_cast<std::size_t>(node)]; }
  Vector3d displacement(int node) const { return solution.displacement[static_cast<std::size_t>(node)]; }
  Vector3d deformed(int node) const { return rest(node) + displacement(node); }
  int node(const cases::Region& region) const { return cases::select_node(scene.mesh, region); }
};

double component_of(const Vector3d& vector, cases::Component component) {
  return component == cases::Component::norm ? vector.norm() : vector[static_cast<int>(component)];
}

double tilt(const cases::Measure& measure, const Configuration& at) {
  const Vector3d edge = at.deformed(at.node(measure.top)) - at.deformed(at.node(measure.bottom));
  return degrees_per_radian *
         std::atan2(edge[static_cast<int>(measure.toward)], edge[static_cast<int>(measure.axis)]);
}

double twist(const cases::Measure& measure, const Configuration& at) {
  const int node = at.node(measure.node), centre = at.node(measure.centre);
  const Vector3d axis = Vector3d::Unit(static_cast<int>(measure.axis));
  const auto across = [&](const Vector3d& v) { return Vector3d(v - axis.dot(v) * axis); };
  const Vector3d before = across(at.rest(node) - at.rest(centre));
  const Vector3d after = across(at.deformed(node) - at.deformed(centre));
  return degrees_per_radian * std::atan2(axis.dot(before.cross(after)), before.dot(after));
}

} // namespace

double evaluate(const cases::Measure& measure, const cases::Scene& scene, const cases::Solution& solution) {
  const Configuration at{scene, solution};
  switch (measure.kind) {
  case MeasureKind::coordinate:
    return at.deformed(at.node(measure.node))[static_cast<int>(measure.axis)];
  case MeasureKind::displacement:
    return component_of(at.displacement(at.node(measure.node)), measure.component);
  case MeasureKind::tilt:
    return tilt(measure, at);
  case MeasureKind::twist:
    return twist(measure, at);
  case MeasureKind::volume:
    return std::accumulate(solution.cell_volume.begin(), solution.cell_volume.end(), 0.0);
  case MeasureKind::displacement_field_l2:
  case MeasureKind::displacement_field_max:
    break;
  }
  throw cases::InputError(measure.where, "not available yet: field norms");
}

std::string unit_of(const cases::Measure& measure) {
  switch (measure.kind) {
  case MeasureKind::tilt:
  case MeasureKind::twist:
    return "deg";
  case MeasureKind::volume:
    return "mm3";
  default:
    return "mm";
  }
}

std::optional<double> error_percent(double fem, double msm) {
  const double error = (msm - fem) / fem * 100;
  // A reference that is zero but for rounding has no relative error.
  if (!std::isfinite(error) || !(std::abs(fem) > 1e-9 * std::abs(msm))) return std::nullopt;
  return error;
}

} // namespace compare
