#include "mechanics/contact/signed_distance.hpp"

#include "mechanics/contact/surface_distance.hpp"

#include <Eigen/Geometry>
#include <memory>

namespace springproof::mechanics {

namespace {

using cases::tools::Cylinder;
using cases::tools::Plane;
using cases::tools::Punch;
using cases::tools::Sphere;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A point as seen from an axis through the origin.
struct FromAxis {
  double along;    ///< mm
  double distance; ///< mm, from the axis
  Vector3d out;    ///< unit length, from the axis to the point; across the axis where the point is on it

  FromAxis(const Vector3d& point, const Vector3d& axis) : along(point.dot(axis)) {
    const Vector3d across = point - along * axis;
    distance = across.norm();
    out = distance > 0 ? Vector3d(across / distance) : axis.unitOrthogonal();
  }
  /// Second derivative of the distance from the axis, 1/mm.
  Matrix3d curvature(const Vector3d& axis) const {
    if (distance == 0) return Matrix3d::Zero();
    const Vector3d around = axis.cross(out);
    return around * around.transpose() / distance;
  }
};

SignedDistance distance_to(const Sphere& sphere, const Vector3d& point) {
  const double distance = point.norm();
  if (distance == 0) return {-sphere.radius, Vector3d::UnitZ()};
  const Vector3d out = point / distance;
  return {distance - sphere.radius, out, (Matrix3d::Identity() - out * out.transpose()) / distance};
}

SignedDistance distance_to(const Cylinder& cylinder, const Vector3d& point) {
  const FromAxis seen(point, cylinder.axis);
  return {seen.distance - cylinder.radius, seen.out, seen.curvature(cylinder.axis)};
}

SignedDistance distance_to(const Plane& plane, const Vector3d& point) {
  return {point.dot(plane.normal), plane.normal};
}

SignedDistance distance_to(const Punch& punch, const Vector3d& point) {
  constexpr double on_edge = 1e-9; // relative to the radius
  const FromAxis seen(point, punch.axis);
  const double ahead = seen.along, beside = seen.distance - punch.radius;
  if (beside < -on_edge * punch.radius && ahead >= beside) return {ahead, punch.axis};
  const Matrix3d around = seen.curvature(punch.axis);
  if (ahead <= 0) return {beside, seen.out, around};
  const double out = std::max(beside, 0.), distance = std::hypot(out, ahead);
  const Vector3d normal = (out * seen.out + ahead * punch.axis) / distance,
                 along = (ahead * seen.out - out * punch.axis) / distance; // in the plane of the axis
  return {distance, normal, along * along.transpose() / distance + normal.dot(seen.out) * around};
}

} // namespace

DistanceAt distance_from(const cases::tools::Kind& shape) {
  const auto of_shape = [](const auto& one) -> DistanceAt {
    if constexpr (std::is_same_v<std::decay_t<decltype(one)>, cases::tools::Surface>) {
      return [surface = std::make_shared<const SurfaceDistance>(one)](const Vector3d& p) {
        return surface->at(p);
      };
    } else {
      return [one](const Vector3d& p) { return distance_to(one, p); };
    }
  };
  return std::visit(of_shape, shape);
}

} // namespace springproof::mechanics
