#include "compare/measure/landmarks.hpp"

#include "mechanics/surface/rays.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

constexpr std::size_t n_triangles = 5; // of a landmark, as in the thesis

/// The surface in both models.
struct Surfaces {
  mechanics::EmbeddedSurface embedded;
  std::vector<Vector3d> fem, msm; ///< mm, one per vertex
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

void measure(const Surfaces& surfaces, const Vector3d& point, LandmarkDistance& landmark) {
  const cases::TriangleMesh& rest = surfaces.embedded.rest;
  std::vector<double> lengths, moved;
  const std::vector<std::size_t> nearest = nearest_triangles(rest, point);
  for (const std::size_t t : nearest) {
    const auto& triangle = rest.triangles[t];
    const Vector3d at_rest = cases::barycentre(triangle, rest.vertices);
    if (t == nearest.front()) landmark.from_point = (at_rest - point).norm();
    moved.push_back((cases::barycentre(triangle, surfaces.fem) - at_rest).norm());
    const mechanics::Ray ray{cases::barycentre(triangle, surfaces.msm),
                             cases::doubled_area(triangle, surfaces.msm)};
    if (const auto length = mechanics::distance_to_surface(ray, rest.triangles, surfaces.fem))
      lengths.push_back(*length);
  }
  landmark.moved = mean_of(moved);
  landmark.n_rays = static_cast<int>(lengths.size());
  if (lengths.empty()) {
    landmark.missing = "no ray from the springs' surface meets the finite elements'";
    return;
  }
  landmark.mean = mean_of(lengths);
  if (lengths.size() < 2) return;
  double squares = 0;
  for (const double length : lengths) squares += (length - *landmark.mean) * (length - *landmark.mean);
  landmark.deviation = std::sqrt(squares / static_cast<double>(lengths.size() - 1));
}

std::string why_not(const Answers& answers) {
  if (!answers.fem.converged() || !answers.msm.converged()) return "needs both models' solutions";
  if (answers.fem.solution.sharing || answers.msm.solution.sharing)
    return "is measured on one rank: several share the solutions";
  return "";
}

} // namespace

mechanics::EmbeddedSurface embedded_surface(const cases::Scene& scene) {
  const auto& file = scene.definition.surface;
  try {
    return mechanics::embed(file ? scene.surface : cases::outer_surface(scene.mesh), scene.mesh);
  } catch (const std::runtime_error& error) {
    if (!file) throw;
    throw cases::InputError(file->where, file->path + ": " + error.what());
  }
}

std::vector<LandmarkDistance> landmark_distances(const cases::Scene& scene, const Answers& answers) {
  std::vector<LandmarkDistance> distances;
  if (scene.definition.landmarks.empty()) return distances;
  const std::string missing = why_not(answers);
  Surfaces surfaces;
  if (missing.empty()) {
    surfaces.embedded = embedded_surface(scene);
    mechanics::move(surfaces.embedded, answers.fem.solution.displacement, surfaces.fem);
    mechanics::move(surfaces.embedded, answers.msm.solution.displacement, surfaces.msm);
  }
  for (const cases::Landmark& landmark : scene.definition.landmarks) {
    distances.push_back({landmark.name, {}, 0, {}, {}, {}, missing});
    if (missing.empty()) measure(surfaces, landmark.point, distances.back());
  }
  return distances;
}

} // namespace springproof::compare
