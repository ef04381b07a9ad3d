#include "mechanics/surface/rays.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace springproof::mechanics {

using Eigen::Vector3d;

/// Source: T. Moeller, B. Trumbore, Fast, minimum storage ray/triangle intersection, 1997.
std::optional<double> distance_along(const Ray& ray, const std::array<Vector3d, 3>& triangle) {
  constexpr double rounding = 1e-12; // relative: else a ray through a common edge could miss both triangles
  const Vector3d direction = ray.direction.normalized();
  const Vector3d first = triangle[1] - triangle[0], second = triangle[2] - triangle[0];
  const Vector3d across = direction.cross(second), from_corner = ray.origin - triangle[0];
  const double determinant = first.dot(across);
  if (!(std::abs(determinant) > rounding * first.norm() * second.norm())) return std::nullopt;
  const Vector3d turned = from_corner.cross(first);
  const double u = from_corner.dot(across) / determinant, v = direction.dot(turned) / determinant;
  if (!(u >= -rounding && v >= -rounding && u + v <= 1 + rounding)) return std::nullopt;
  return second.dot(turned) / determinant;
}

std::optional<double> distance_to_surface(const Ray& ray, const std::vector<std::array<int, 3>>& triangles,
                                          const std::vector<Vector3d>& positions) {
  std::optional<double> nearest;
  for (const auto& [a, b, c] : triangles)
    if (const auto met = distance_along(
            ray, {positions[cases::index(a)], positions[cases::index(b)], positions[cases::index(c)]}))
      nearest = std::min(std::abs(*met), nearest.value_or(std::numeric_limits<double>::infinity()));
  return nearest;
}

Spheres cover(const std::vector<Vector3d>& positions, std::size_t n) {
  Spheres spheres{{}, 0};
  std::vector<double> squared(positions.size(), std::numeric_limits<double>::infinity()); // mm², to a centre
  for (std::size_t next = 0; spheres.vertices.size() < n;) {
    spheres.vertices.push_back(static_cast<int>(next));
    const Vector3d& centre = positions[next];
    for (std::size_t v = 0; v < positions.size(); ++v)
      squared[v] = std::min(squared[v], (positions[v] - centre).squaredNorm());
    next = cases::index(std::max_element(squared.begin(), squared.end()) - squared.begin());
    spheres.radius = std::sqrt(squared[next]);
    if (squared[next] == 0) break; // every vertex is a centre
  }
  return spheres;
}

std::optional<std::size_t> pick(const Spheres& spheres, const std::vector<Vector3d>& positions,
                                const Ray& ray) {
  const Vector3d direction = ray.direction.normalized();
  const double squared_radius = spheres.radius * spheres.radius;
  std::optional<std::size_t> picked;
  std::array<double, 2> best{}; // where the ray enters, and how far the centre is, mm
  for (std::size_t s = 0; s < spheres.vertices.size(); ++s) {
    const Vector3d to_centre = positions[cases::index(spheres.vertices[s])] - ray.origin;
    const double along = to_centre.dot(direction),
                 inside = squared_radius - (to_centre - along * direction).squaredNorm();
    if (!(inside >= 0 && along + std::sqrt(inside) >= 0)) continue;
    const std::array<double, 2> here{std::max(0.0, along - std::sqrt(inside)), to_centre.norm()};
    if (picked && !(here < best)) continue;
    picked = s;
    best = here;
  }
  return picked;
}

} // namespace springproof::mechanics
