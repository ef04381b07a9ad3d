#pragma once

#include "cases/case/read_case.hpp"
#include "compare/interact/pulled_body.hpp"

#include <algorithm>
#include <string>

namespace springproof {

/// @param cells  numbers along x, y and z; with 12 along x the springs take the multigrid path
inline cases::Scene block(const std::string& cells, const std::string& damping = "mass_damping = 30",
                          const std::string& scheme = "scheme = \"implicit_euler\"",
                          const std::string& gravity = "1e-6") {
  return cases::make_scene(cases::read_case_text(R"(schema = 1
name = "block"
[body]
shape = "box"
size = [40, 40, 60]
cells = )" + cells + R"(
[material]
model = "linear_elastic"
youngs_modulus = 0.005
poissons_ratio = 0.3
density = 1000
)" + damping + R"(
[[fixed]]
region = "z-"
[[load]]
kind = "gravity"
value = [0, 0, )" + gravity + R"(]
[dynamics]
)" + scheme + R"(
step = 0.02
end = 1
[fem]
accuracy = "none"
[msm]
design = "moduli"
[[measure]]
name = "top"
kind = "displacement"
node = "z+ x+ y+"
component = "x"
)",
                                                 "block.toml"));
}

inline const mechanics::Ray from_right{{200, 20, 50}, {-1, 0, 0}};

inline double largest_displacement(compare::PulledBody& body) {
  double largest = 0;
  for (const Eigen::Vector3d& u : body.displacement()) largest = std::max(largest, u.norm());
  return largest;
}

} // namespace springproof
