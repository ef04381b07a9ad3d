#pragma once

#include "cases/mesh/triangle_mesh.hpp"

/// What a ray meets: spheres to grab a surface by, and other surfaces.
namespace springproof::mechanics {

struct Ray {
  Eigen::Vector3d origin;    ///< mm
  Eigen::Vector3d direction; ///< any length but 0
};

/// Where a line meets a triangle, as a distance from the ray's origin in mm: negative behind it. A line along
/// the triangle's plane meets it nowhere; one through its edge meets it.
std::optional<double> distance_along(const Ray& ray, const std::array<Eigen::Vector3d, 3>& triangle);

/// The place where the line of a ray, to both sides, meets a surface nearest to its origin.
/// @param positions  mm, one per vertex   @return mm, not negative; nothing where it meets none
std::optional<double> distance_to_surface(const Ray& ray, const std::vector<std::array<int, 3>>& triangles,
                                          const std::vector<Eigen::Vector3d>& positions);

/// Equal spheres about vertices of a surface, which together hold all of its vertices at rest.
struct Spheres {
  std::vector<int> vertices; ///< centres, one per sphere: vertices of the surface, which move with it
  double radius;             ///< mm
};

/// Covers vertices; each next centre is the vertex furthest from those before (farthest-point sampling;
/// Gonzalez 1985: the radius is at most twice the smallest that so many spheres can have).
/// @param positions  mm, of the vertices at rest, at least one
/// @param n  number of spheres, > 0; where vertices are fewer, each is a centre and the radius is 0
Spheres cover(const std::vector<Eigen::Vector3d>& positions, std::size_t n);

/// Finds the sphere that a ray enters first or begins in; of several, the one centred nearest to its origin.
/// @param positions  mm, where the surface's vertices are now
/// @return its place among the spheres; nothing where the ray misses all
std::optional<std::size_t> pick(const Spheres& spheres, const std::vector<Eigen::Vector3d>& positions,
                                const Ray& ray);

} // namespace springproof::mechanics
