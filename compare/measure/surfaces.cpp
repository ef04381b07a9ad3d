#include "compare/measure/surfaces.hpp"

#include "cases/scene/regions.hpp"
#include "compare/measure/measure.hpp"
#include "mechanics/larger.hpp"
#include "mechanics/surface/rays.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

constexpr std::size_t n_triangles = 5; // number per landmark, as in the thesis

/// The surface at rest, and as it has been moved: mm, one place per vertex; empty: that answer is missing.
struct Surfaces {
  mechanics::EmbeddedSurface embedded;
  std::vector<Vector3d> fem, msm, equilibrium;
};

/// Numbers of the triangles whose barycentres are nearest to a point at rest, the nearest first.
std::vector<std::size_t> nearest_triangles(const cases::TriangleMesh& surface, const Vector3d& point) {
  std::vector<double> squared;
  for (const auto& triangle : surface.triangles)
    squared.push_back((cases::barycentre(triangle, surface.vertices) - point).squaredNorm());
  std::vector<std::size_t> order(squared.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t n = std::min(n_triangles, order.size());
  std::partial_sort(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n), order.end(),
      [&](std::size_t a, std::size_t b) { return std::pair(squared[a], a) < std::pair(squared[b], b); });
  order.resize(n);
  return order;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Casts rays from the springs' surface at these triangles to another surface.
RayLengths ray_lengths(const Surfaces& surfaces, const std::vector<std::size_t>& from,
                       const std::vector<Vector3d>& to) {
  const auto& triangles = surfaces.embedded.rest.triangles;
  std::vector<double> lengths;
  for (const std::size_t t : from) {
    const mechanics::Ray ray{cases::barycentre(triangles[t], surfaces.msm),
                             cases::doubled_area(triangles[t], surfaces.msm)};
    if (const auto length = mechanics::distance_to_surface(ray, triangles, to)) lengths.push_back(*length);
  }
  RayLengths found{static_cast<int>(lengths.size()), {}, {}};
  if (lengths.empty()) return found;
  found.mean = mean_of(lengths);
  if (lengths.size() < 2) return found;
  double squares = 0;
  for (const double length : lengths) squares += (length - *found.mean) * (length - *found.mean);
  found.deviation = std::sqrt(squares / static_cast<double>(lengths.size() - 1));
  return found;
}

void measure(const Surfaces& surfaces, const Vector3d& point, LandmarkDistance& landmark) {
  const cases::TriangleMesh& rest = surfaces.embedded.rest;
  const std::vector<std::size_t> nearest = nearest_triangles(rest, point);
  const auto at_rest = [&](std::size_t t) { return cases::barycentre(rest.triangles[t], rest.vertices); };
  landmark.from_point = (at_rest(nearest.front()) - point).norm();
  if (!surfaces.equilibrium.empty())
    landmark.to_equilibrium = ray_lengths(surfaces, nearest, surfaces.equilibrium);
  if (surfaces.fem.empty()) return;
  std::vector<double> moved;
  for (const std::size_t t : nearest)
    moved.push_back((cases::barycentre(rest.triangles[t], surfaces.fem) - at_rest(t)).norm());
  landmark.moved = mean_of(moved);
  landmark.to_fem = ray_lengths(surfaces, nearest, surfaces.fem);
  if (!landmark.to_fem.mean) landmark.missing = "no ray from the springs' surface meets the finite elements'";
}

std::string why_not(const Answers& answers) {
  if (!answers.fem.converged() || !answers.msm.converged()) return "needs both models' solutions";
  if (answers.fem.solution.sharing || answers.msm.solution.sharing)
    return "is measured on one rank: several share the solutions";
  return "";
}

/// The springs' displacement in equilibrium, where their answer is another one; empty otherwise.
std::vector<Vector3d> equilibrium_of(const cases::Solution& springs) {
  if (!springs.from_equilibrium || springs.sharing) return {};
  return springs.from_equilibrium->displacement;
}

} // namespace

mechanics::EmbeddedSurface embedded_surface(const cases::Scene& scene) {
  const auto& file = scene.definition.surface;
  const auto outer = [&] {
    return cases::triangles_of_faces(scene.mesh, cases::surface_faces(scene.mesh, scene.definition.symmetry));
  };
  try {
    return mechanics::embed(file ? scene.surface : outer(), scene.mesh);
  } catch (const std::runtime_error& error) {
    if (!file) throw;
    file->file.refuse(error.what());
  }
}

std::vector<LandmarkDistance> landmark_distances(const cases::Scene& scene, const Answers& answers) {
  std::vector<LandmarkDistance> distances;
  if (scene.definition.landmarks.empty()) return distances;
  const std::string missing = why_not(answers);
  const auto equilibrium = equilibrium_of(answers.msm.solution);
  const bool is_measured = missing.empty() || !equilibrium.empty();
  Surfaces surfaces;
  if (is_measured) {
    surfaces.embedded = embedded_surface(scene);
    mechanics::move(surfaces.embedded, answers.msm.solution.displacement, surfaces.msm);
    if (missing.empty()) mechanics::move(surfaces.embedded, answers.fem.solution.displacement, surfaces.fem);
    if (!equilibrium.empty()) mechanics::move(surfaces.embedded, equilibrium, surfaces.equilibrium);
  }
  for (const cases::Landmark& landmark : scene.definition.landmarks) {
    distances.push_back({landmark.name, {}, {}, {}, {}, missing});
    if (is_measured) measure(surfaces, landmark.point, distances.back());
  }
  return distances;
}

std::optional<SurfaceMotion> surface_motion(const cases::Scene& scene, const Answers& answers) {
  if (!scene.definition.surface || !answers.fem.converged() || !answers.msm.converged()) return std::nullopt;
  const auto& fem = answers.fem.solution.trajectory;
  const auto& msm = answers.msm.solution.trajectory;
  if (!fem || !msm || fem->bodies.size() != msm->bodies.size()) return std::nullopt;
  const mechanics::EmbeddedSurface surface = embedded_surface(scene);
  if (surface.vertices.empty()) return std::nullopt;
  const auto n = static_cast<double>(surface.vertices.size());
  SurfaceMotion motion;
  for (std::size_t body = 0; body < fem->bodies.size(); ++body) {
    double of_fem = 0, of_msm = 0, of_difference = 0, largest = 0;
    for (const mechanics::EmbeddedPoint& vertex : surface.vertices) {
      const Eigen::Vector3d reference = mechanics::displacement_at(vertex, fem->bodies[body].displacement);
      const Eigen::Vector3d other = mechanics::displacement_at(vertex, msm->bodies[body].displacement);
      const double apart = (other - reference).squaredNorm();
      of_fem += reference.squaredNorm();
      of_msm += other.squaredNorm();
      of_difference += apart;
      largest = mechanics::larger(largest, apart);
    }
    motion.time.push_back(fem->time[cases::index(fem->bodies[body].step)]);
    motion.fem.push_back(std::sqrt(of_fem / n));
    motion.msm.push_back(std::sqrt(of_msm / n));
    motion.difference.push_back(std::sqrt(of_difference / n));
    motion.largest.push_back(std::sqrt(largest));
  }
  const auto size = value_over_time(cases::OverTime::trajectory_l2, {motion.time, motion.fem});
  const auto apart = value_over_time(cases::OverTime::trajectory_l2, {motion.time, motion.difference});
  const double zero = zero_of_displacements(scene, answers.fem.solution);
  if (size && apart) motion.error_percent = error_percent(*size, *size + *apart, zero); // apart/size
  return motion;
}

} // namespace springproof::compare
