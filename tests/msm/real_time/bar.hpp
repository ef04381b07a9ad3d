#pragma once

#include "mechanics/larger.hpp"
#include "msm/real_time/real_time.hpp"

namespace springproof {

inline const msm::CellStiffness springs_of_cells{0.2, 0.1, 0.3, 0.05}; // N/mm, MPa

/// A bar of water of 3 x 2 x 2 cells, held at one end, under an acceleration that swings it.
/// @param acceleration  m/s²
inline cases::Scene bar(cases::StepMethod method, int iterations, const Eigen::Vector3d& acceleration) {
  cases::Case definition;
  definition.body = cases::Box{{30, 20, 20}, {3, 2, 2}};
  definition.fixed.push_back({cases::Region{"x-"}, {true, true, true}});
  definition.material_dynamics = {1000., 1, 0};
  cases::Scene scene = cases::make_scene(definition);
  scene.loads.push_back({{}, {{}, cases::loads::Gravity{acceleration}}});
  scene.definition.dynamics.emplace();
  scene.definition.dynamics->scheme.scheme = cases::Scheme::implicit_euler;
  scene.definition.dynamics->step = 0.01;
  scene.definition.dynamics->end = 0.03;
  scene.definition.msm.real_time = cases::RealTime{method, iterations, {}, {}, 0.01, 20, 5};
  return scene;
}

inline msm::Points end_of(const cases::Scene& scene, int n_threads = 1) {
  const auto settings = scene.definition.msm.real_time
                            ? msm::in_substeps(scene, {springs_of_cells}, scene.definition.dynamics->step)
                            : mechanics::IntegrationSettings{};
  return msm::follow(scene, {springs_of_cells}, {msm::Path::automatic, n_threads, {}, {}}, settings)
      .displacement;
}

/// Largest difference relative to the largest displacement.
inline double apart(const msm::Points& a, const msm::Points& b) {
  double difference = 0, size = 0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    difference = mechanics::larger(difference, (a[p] - b[p]).norm());
    size = mechanics::larger(size, b[p].norm());
  }
  return difference / size;
}

/// By Newton's method.
inline msm::Points solved(cases::Scene scene) {
  scene.definition.msm.real_time.reset();
  return end_of(scene);
}

inline const Eigen::Vector3d sideways(0, 0, -9.81), lengthwise(9.81, 0, 0);

} // namespace springproof
