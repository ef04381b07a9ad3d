#include "fem_reference/grid/traction.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace springproof::fem_reference::grid {

using cases::index;

NineForces traction_on(const cases::Scene::AppliedLoad& applied,
                       const std::array<Eigen::Vector3d, 4>& vertices, double moment) {
  // Gauss's four points on the unit interval: exact for a quadratic shape times a linear traction
  const double inner = std::sqrt(3. / 7 - 2. / 7 * std::sqrt(1.2)),
               outer = std::sqrt(3. / 7 + 2. / 7 * std::sqrt(1.2));
  const double at[4] = {(1 - outer) / 2, (1 - inner) / 2, (1 + inner) / 2, (1 + outer) / 2};
  const double light = (18 - std::sqrt(30.)) / 72, heavy = (18 + std::sqrt(30.)) / 72;
  const double weight[4] = {light, heavy, heavy, light};
  const auto shape = [](double x) {
    return Eigen::Vector3d((1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1));
  };
  const Eigen::Vector3d u = vertices[1] - vertices[0], v = vertices[3] - vertices[0];
  const double area = u.cross(v).norm();
  NineForces forces;
  forces.fill(Eigen::Vector3d::Zero());
  for (int p = 0; p < 4; ++p)
    for (int q = 0; q < 4; ++q) {
      const Eigen::Vector3d traction =
          cases::surface_traction(applied, vertices[0] + at[p] * u + at[q] * v, moment);
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a)
          forces[index(a + 3 * b)] +=
              area * weight[p] * weight[q] * shape(at[p])[a] * shape(at[q])[b] * traction;
    }
  return forces;
}

} // namespace springproof::fem_reference::grid
