#pragma once

#include "cases/scene/scene.hpp"

/// What tests of both models' steps in real time ask of a body that nothing holds.
namespace springproof::free_bar {

/// The body of a scene without supports and damping, in ten steps of a millisecond, drawn at its last node.
/// @param force  N
inline cases::Scene drawn(cases::Scene scene, const Eigen::Vector3d& force) {
  scene.definition.material_dynamics.mass_damping = 0;
  scene.constrained.clear();
  scene.loads.clear();
  cases::Scene::AppliedLoad load{{}, {{}, cases::loads::NodalForce{force}}};
  load.selection.nodes = {static_cast<int>(scene.mesh.nodes.size()) - 1};
  scene.loads.push_back(load);
  scene.definition.dynamics->step = 0.001;
  scene.definition.dynamics->end = 0.01;
  return scene;
}

} // namespace springproof::free_bar
