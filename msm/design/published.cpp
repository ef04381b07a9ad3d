#include "msm/design/published.hpp"

namespace springproof::msm {

CellStiffness ladd_kinney(double youngs_modulus, double edge) {
  const double k = 2 * youngs_modulus * edge / 5;
  return {k / 4, k / 2, 0, 0};
}

CellStiffness baudet(double youngs_modulus, double poissons_ratio, double edge) {
  const double unit = youngs_modulus * edge / (8 * (1 + poissons_ratio));
  return {(4 * poissons_ratio + 1) * unit, 0, 3 * unit, 0};
}

CellStiffness uniform_springs(double stiffness) {
  return {stiffness / 4, stiffness / 2, stiffness, 0};
}

double uniform_stiffness(double youngs_modulus, double edge) {
  return youngs_modulus * edge / 2.7;
}

} // namespace springproof::msm
