#pragma once

#include "cases/case/tool.hpp"

#include <functional>

namespace springproof::mechanics {

/// The distance of a point from a tool's surface, with its derivatives by the point.
struct SignedDistance {
  double value;           ///< mm; < 0: the point is inside
  Eigen::Vector3d normal; ///< gradient, of unit length, out of the tool
  Eigen::Matrix3d curvature =
      Eigen::Matrix3d::Zero(); ///< second derivative, 1/mm, >= 0 outside; < 0 inside of what is hollow
};

/// The distance of a point as seen from a tool's place (Tool::at), mm.
using DistanceAt = std::function<SignedDistance(const Eigen::Vector3d& from_tool)>;

/// Returns what finds exact distances from a tool's shape, from any thread. Where several places of the
/// surface are nearest, they are those of one of them; a point on a punch's edge is beside its flat end.
DistanceAt distance_from(const cases::tools::Kind& shape);

} // namespace springproof::mechanics
