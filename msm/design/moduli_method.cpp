#include "msm/design/moduli_method.hpp"

#include "msm/design/bounded_least_squares.hpp"

#include <cmath>

namespace springproof::msm {

namespace {

/// Springs nearest to the cubic elasticity with C12 = C44.
CellStiffness nearest_springs(double c11, double c44, double split, const CellVertices& vertices) {
  Elasticity target = Elasticity::Zero();
  target.topLeftCorner<3, 3>().setConstant(c44);
  target.diagonal() << Eigen::Vector3d::Constant(c11), Eigen::Vector3d::Constant(c44);
  const CellStiffness unit_shear = {0, (1 - split) / 2, 0.75 * split, 0};
  Eigen::MatrixXd unit(36, 2);
  unit.col(0) = cell_elasticity({1, 0, 0, 0}, vertices).reshaped();
  unit.col(1) = cell_elasticity(unit_shear, vertices).reshaped();
  const double size = c11 * std::cbrt(cases::cell_volume(vertices));
  const Eigen::VectorXd k = bounded_least_squares(unit, target.reshaped(), size);
  return {k(0), k(1) * unit_shear.face_diagonal, k(1) * unit_shear.internal_diagonal, 0};
}

} // namespace

double c11_of_springs(double youngs_modulus, double shear_modulus) {
  const double difference = youngs_modulus - shear_modulus, sum = youngs_modulus + shear_modulus;
  return (difference + std::sqrt(sum * sum + 8 * shear_modulus * shear_modulus)) / 2;
}

CellStiffness moduli_method(double youngs_modulus, double shear_modulus, double split,
                            const CellVertices& vertices) {
  return nearest_springs(c11_of_springs(youngs_modulus, shear_modulus), shear_modulus, split, vertices);
}

CellStiffness hybrid_method(double lame_lambda, double lame_mu, double split, const CellVertices& vertices) {
  CellStiffness stiffness = nearest_springs(3 * lame_mu, lame_mu, split, vertices);
  stiffness.volume = lame_lambda - lame_mu;
  return stiffness;
}

} // namespace springproof::msm
