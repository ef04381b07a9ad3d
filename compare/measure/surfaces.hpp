#pragma once

#include "cases/scene/scene.hpp"
#include "compare/solve/answers.hpp"
#include "mechanics/surface/embedded_surface.hpp"

/// How far the surfaces of both models are apart: at landmarks, and while they move.
namespace springproof::compare {

/// Lengths of the rays that met the other surface.
struct RayLengths {
  int n_rays = 0;
  std::optional<double> mean, deviation; ///< mm; nothing where no ray, or but one, met it
};

/// How far the springs' surface is from another one about a point of it.
struct LandmarkDistance {
  std::string name;
  std::optional<double>
      from_point;              ///< mm: distance to the nearest triangle's barycentre, in the body at rest
  RayLengths to_fem;           ///< rays to the finite elements' surface
  std::optional<double> moved; ///< mm: mean displacement of the barycentres in the finite elements
  /// Rays to the same springs' surface in equilibrium, where they were stopped after some iterations.
  std::optional<RayLengths> to_equilibrium;
  std::string missing{}; ///< why the finite elements have nothing
};

/// Finds the distances at every landmark of a case, in its order. Rays start on the surface as the springs
/// have moved it, at the barycentres of the five triangles nearest to the landmark at rest. Along the
/// triangles' normals, to either side, they end at the nearest place of the other answer's surface. The
/// deviation is a sample's (n - 1). The surface is the scene's, or the outer one of the body's cells. A
/// dynamic case is measured at its end. Source: thesis section 6.1.4.3 and table 6.1.
std::vector<LandmarkDistance> landmark_distances(const cases::Scene& scene, const Answers& answers);

/// The surface that a case names, or else the outer one of its cells, bound to the cells.
/// @throws cases::InputError at the place of the surface in the case file if it cannot be bound
mechanics::EmbeddedSurface embedded_surface(const cases::Scene& scene);

/// How far the springs' surface is from the finite elements' while both move.
struct SurfaceMotion {
  std::vector<double> time; ///< s, of the written bodies
  std::vector<double> fem;  ///< mm: root mean square, over the vertices, of the finite elements' displacement
  std::vector<double> msm;  ///< mm: the same of the springs'
  std::vector<double> difference;      ///< mm: the same of the difference of both models' displacements
  std::vector<double> largest;         ///< mm: the largest difference of a vertex
  std::optional<double> error_percent; ///< root mean square of difference over time, over that of fem
};

/// Follows the surface that a dynamic case names ([surface]), at the times of its written bodies, with
/// dynamics.write_every; vertices count alike. Nothing where the case names no surface, or a model did not
/// move to the end; no error where the finite elements' surface rests but for rounding.
/// @throws cases::InputError if the surface cannot be bound to the cells
std::optional<SurfaceMotion> surface_motion(const cases::Scene& scene, const Answers& answers);

} // namespace springproof::compare
