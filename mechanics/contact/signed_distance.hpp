#pragma once

#include "cases/case/tool.hpp"

namespace springproof::mechanics {

/// The distance of a point from a tool's surface, with its derivatives by the point.
struct SignedDistance {
  double value;           ///< mm; < 0: the point is inside
  Eigen::Vector3d normal; ///< gradient, of unit length, out of the tool
  Eigen::Matrix3d curvature =
      Eigen::Matrix3d::Zero(); ///< second derivative, 1/mm, >= 0 outside and near inside
};

/// Returns the exact distance to a tool's shape. Where several places of the surface are nearest, it goes by
/// one of them; a point on a punch's edge is beside its flat end.
/// @param from_tool  the point as seen from the tool's place (Tool::at), mm
SignedDistance signed_distance(const cases::tools::Kind& shape, const Eigen::Vector3d& from_tool);

} // namespace springproof::mechanics
