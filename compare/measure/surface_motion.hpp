#pragma once

#include "cases/scene/scene.hpp"
#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// How far the springs' surface is from the finite elements' while both move.
struct SurfaceMotion {
  std::vector<double> time; ///< s, of the written bodies
  std::vector<double> fem;  ///< mm: root mean square, over the vertices, of the finite elements' displacement
  std::vector<double> msm;  ///< mm: the same of the springs'
  std::vector<double> difference;      ///< mm: the same of the difference of both models' displacements
  std::vector<double> largest;         ///< mm: the largest difference of a vertex
  std::optional<double> error_percent; ///< root mean square of difference over time, over that of fem
};

/// Of the surface that a dynamic case names ([surface]), at the times of its written bodies, with
/// dynamics.write_every; vertices count alike. Nothing where the case names no surface, or a model did not
/// move to the end; no error where the finite elements' surface rests but for rounding.
/// @throws cases::InputError if the surface cannot be bound to the cells
std::optional<SurfaceMotion> surface_motion(const cases::Scene& scene, const Answers& answers);

} // namespace springproof::compare
