#include "msm/design/small_strain.hpp"

#include "cases/case/error.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "msm/design/minimise.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::msm {

cases::LinearElastic small_strain_material(const cases::Material& material) {
  if (const auto* linear = std::get_if<cases::LinearElastic>(&material)) return *linear;
  if (std::holds_alternative<cases::TransverselyIsotropic>(material))
    throw cases::InputError(
        "material.model: is \"transversely_isotropic\", and an isotropic material is wanted here");
  const auto& ogden = std::get<cases::Ogden>(material);
  const double mu = mechanics::shear_modulus(ogden);
  if (!ogden.bulk_modulus) return {3 * mu, 0.5};
  return mechanics::linear_elastic(mu, *ogden.bulk_modulus);
}

std::optional<Elasticity> elasticity_at_rest(const cases::Material& material) {
  Elasticity c = Elasticity::Zero();
  if (const auto* fibrous = std::get_if<cases::TransverselyIsotropic>(&material)) {
    const auto axis = cases::axis_along(fibrous->fibre);
    if (!axis) return std::nullopt;
    const mechanics::TransverseModuli m = mechanics::transverse_moduli(*fibrous);
    const int fibre = static_cast<int>(*axis);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) c(i, j) = i == fibre || j == fibre ? m.c13 : m.c12;
      c(i, i) = i == fibre ? m.c33 : m.c11;
      c(3 + i, 3 + i) = i == fibre ? m.c66 : m.c44;
    }
    return c;
  }
  cases::LinearElastic linear = small_strain_material(material);
  if (!(linear.youngs_modulus > 0)) return std::nullopt;
  // Incompressible is a Poisson's ratio of 0.5 but for what no constant of the comparison shows.
  linear.poissons_ratio = std::min(linear.poissons_ratio, 0.5 - 1e-6);
  const mechanics::ElasticModuli moduli = mechanics::elastic_moduli(linear);
  c.topLeftCorner<3, 3>().setConstant(moduli.lambda);
  c.diagonal() << Eigen::Vector3d::Constant(moduli.lambda + 2 * moduli.mu),
      Eigen::Vector3d::Constant(moduli.mu);
  return c;
}

LinearFit linear_method(const CellMatrix& reference, const CellVertices& vertices) {
  Eigen::MatrixXd unit(576, 3);
  const std::array<CellStiffness, 3> units = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  for (int c = 0; c < 3; ++c)
    unit.col(c) = cell_stiffness_matrix(vertices, units[static_cast<std::size_t>(c)]).reshaped();
  const Eigen::Vector3d k = nonnegative_least_squares(unit, reference.reshaped());
  return {{k(0), k(1), k(2), 0}, (reference.reshaped() - unit * k).norm()};
}

CellStiffness pseudo_stiffness(const CellStiffness& stiffness, double youngs_modulus, double edge) {
  const double unit = youngs_modulus * edge / 2;
  return {stiffness.edge / unit, stiffness.face_diagonal / unit, stiffness.internal_diagonal / unit,
          stiffness.volume / youngs_modulus};
}

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
  const Eigen::VectorXd k = nonnegative_least_squares(unit, target.reshaped());
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
