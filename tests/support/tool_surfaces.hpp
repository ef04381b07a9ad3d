#pragma once

#include "cases/case/tool.hpp"
#include "cases/mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <string>

using namespace springproof;

/// Closed surfaces, for tests of tools that files give.
namespace tool_surfaces {

using Eigen::Vector3d;

/// A ball of 8 n² triangles whose corners are on it: the divided faces of an octahedron.
inline cases::Surface ball(double radius, int n) {
  cases::Surface all;
  for (int octant = 0; octant < 8; ++octant) {
    const Vector3d sign((octant & 1) != 0 ? -1 : 1, (octant & 2) != 0 ? -1 : 1, (octant & 4) != 0 ? -1 : 1);
    const auto add = [&](std::array<std::array<int, 2>, 3> corners) {
      if (sign.prod() < 0) std::swap(corners[1], corners[2]);
      auto& triangle = all.emplace_back();
      for (std::size_t v = 0; v < 3; ++v) {
        const auto& [i, j] = corners[v];
        triangle[v] = radius * Vector3d(i, j, n - i - j).normalized().cwiseProduct(sign);
      }
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        add({{{i, j}, {i + 1, j}, {i, j + 1}}});
        if (i + j + 1 < n) add({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
      }
  }
  return all;
}

/// How deep the faces of the ball are below it at most, mm.
inline double sagitta(const cases::Surface& ball, double radius) {
  double deepest = 0;
  for (const auto& [a, b, c] : ball)
    deepest = std::max(deepest, radius - (b - a).cross(c - a).normalized().dot(a));
  return deepest;
}

inline cases::Surface box(const Vector3d& lower, const Vector3d& upper) {
  const Eigen::AlignedBox3d all(lower, upper);
  const auto at = [&](int corner) {
    return all.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
  };
  cases::Surface surface;
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                   std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    surface.push_back({at(a), at(b), at(c)});
    surface.push_back({at(a), at(c), at(d)});
  }
  return surface;
}

inline cases::tools::Surface tool(const cases::Surface& triangles) {
  const cases::TriangleMesh mesh = cases::joined(triangles);
  return {{"tool.stl"}, 1, mesh.vertices, mesh.triangles};
}

/// The text of an STL file.
inline std::string stl(const cases::Surface& triangles) {
  std::string text = "solid tool\n";
  for (const auto& triangle : triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vector3d& at : triangle)
      text += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", at.x(), at.y(), at.z());
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid tool\n";
}

} // namespace tool_surfaces
