#pragma once

#include "tests/fem_reference/scenes.hpp"
#include "tests/support/bodies.hpp"

namespace scenes {

using bodies::region;

/// A block of soft rubber on a table, 12 mm high, whose weight sets in at once; its period is about 0.08 s.
inline cases::Case block(cases::Formulation formulation, cases::Element element) {
  cases::Case definition;
  definition.body = cases::Box{Eigen::Vector3d(8, 6, 12), {4, 3, 5}};
  definition.material = cases::LinearElastic{0.004, 0.4};
  if (formulation == cases::Formulation::hyperelastic) {
    cases::Ogden ogden = thesis_ogden();
    for (double& mu : ogden.mu) mu *= 0.02;
    ogden.bulk_modulus = 0.01;
    definition.material = ogden;
  }
  definition.material_dynamics = {1000., 0, 0};
  definition.fem.formulation = formulation;
  definition.fem.element = element;
  definition.fixed.push_back({region("z-"), {true, true, true}});
  cases::Measure tip{"", cases::measures::Displacement{region("x+ y+ z+")}};
  cases::Measure volume{"", cases::measures::Volume{}};
  definition.measures = {tip, volume};
  definition.loads = {{{}, cases::loads::Gravity{Eigen::Vector3d(2, 0, -4)}}};
  cases::Dynamics dynamics;
  dynamics.scheme.rho_infinity = 0.6;
  dynamics.step = 0.004;
  dynamics.end = 0.04;
  dynamics.write_every = 1000;
  definition.dynamics = dynamics;
  return definition;
}

} // namespace scenes
