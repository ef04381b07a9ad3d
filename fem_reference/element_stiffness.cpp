#include "fem_reference/element_stiffness.hpp"

#include "cases/case/error.hpp"

#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <string>

namespace springproof::fem_reference {

namespace {

using ShapeGradients = Eigen::Matrix<double, 3, 8>;
using StrainDisplacement = Eigen::Matrix<double, 6, 24>;

struct GaussPoint {
  ShapeGradients gradients; ///< dN_i/dx, 1/mm
  double volume;            ///< weight times Jacobian determinant, mm³
};

// dN_i/d(xi, eta, zeta) at a point of [-1, 1]^3;  N_i = (1 +- xi)(1 +- eta)(1 +- zeta)/8.
ShapeGradients reference_gradients(const Eigen::Vector3d& point) {
  ShapeGradients gradients;
  for (int v = 0; v < 8; ++v) {
    const Eigen::Vector3d sign(v & 1 ? 1 : -1, v & 2 ? 1 : -1, v & 4 ? 1 : -1);
    const Eigen::Vector3d factor = Eigen::Vector3d::Ones() + sign.cwiseProduct(point);
    gradients.col(v) =
        0.125 * Eigen::Vector3d(sign.x() * factor.y() * factor.z(), sign.y() * factor.x() * factor.z(),
                                sign.z() * factor.x() * factor.y());
  }
  return gradients;
}

std::array<GaussPoint, 8> gauss_points(const std::array<Eigen::Vector3d, 8>& vertices) {
  Eigen::Matrix<double, 3, 8> positions;
  for (int v = 0; v < 8; ++v) positions.col(v) = vertices[static_cast<std::size_t>(v)];
  const double a = 1 / std::sqrt(3.0); // 2-point Gauss: +-1/sqrt(3), weight 1
  std::array<GaussPoint, 8> points;
  for (int q = 0; q < 8; ++q) {
    const ShapeGradients reference = reference_gradients({q & 1 ? a : -a, q & 2 ? a : -a, q & 4 ? a : -a});
    const Eigen::Matrix3d jacobian = positions * reference.transpose(); // dx/dxi
    const double determinant = jacobian.determinant();
    if (!(determinant > 0))
      throw cases::InputError("the cell is inverted or degenerate: its Jacobian determinant is " +
                              std::to_string(determinant) + " mm³ at a Gauss point; it must be positive");
    points[static_cast<std::size_t>(q)] = {jacobian.inverse().transpose() * reference, determinant};
  }
  return points;
}

// Rows: xx, yy, zz, xy, yz, xz with engineering shear strains (thesis eq. 4.6).
StrainDisplacement strain_displacement(const ShapeGradients& gradients) {
  StrainDisplacement b = StrainDisplacement::Zero();
  for (int v = 0; v < 8; ++v) {
    const Eigen::Vector3d g = gradients.col(v);
    b.block<6, 3>(0, 3 * v) << g.x(), 0, 0, //
        0, g.y(), 0,                        //
        0, 0, g.z(),                        //
        g.y(), g.x(), 0,                    //
        0, g.z(), g.y(),                    //
        g.z(), 0, g.x();
  }
  return b;
}

Eigen::Matrix<double, 6, 6> elasticity(const cases::LinearElastic& material) {
  const double nu = material.poissons_ratio;
  const double lame_lambda = material.youngs_modulus * nu / ((1 + nu) * (1 - 2 * nu));
  const double lame_mu = material.youngs_modulus / (2 * (1 + nu));
  Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
  d.topLeftCorner<3, 3>().setConstant(lame_lambda);
  d.diagonal() << Eigen::Vector3d::Constant(lame_lambda + 2 * lame_mu), Eigen::Vector3d::Constant(lame_mu);
  return d;
}

// B-bar: the dilatation that B gives, replaced by its mean over the element.
StrainDisplacement with_mean_dilatation(StrainDisplacement b, const ShapeGradients& mean) {
  for (int v = 0; v < 8; ++v) {
    const Eigen::RowVector3d own = b.block<3, 3>(0, 3 * v).diagonal();
    const Eigen::RowVector3d correction = (mean.col(v).transpose() - own) / 3;
    b.block<3, 3>(0, 3 * v).rowwise() += correction;
  }
  return b;
}

void check_input(const cases::LinearElastic& material, cases::Element element) {
  if (element != cases::Element::q1 && element != cases::Element::q1_bbar)
    throw cases::InputError("element stiffness: the element must be q1 or q1_bbar");
  if (!(material.youngs_modulus > 0) || !std::isfinite(material.youngs_modulus))
    throw cases::InputError("youngs_modulus: must be positive and finite");
  if (!(material.poissons_ratio > -1 && material.poissons_ratio < 0.5))
    throw cases::InputError("poissons_ratio: must lie in (-1, 0.5), where the elasticity matrix is finite");
}

} // namespace

ElementStiffness element_stiffness(const std::array<Eigen::Vector3d, 8>& vertices,
                                   const cases::LinearElastic& material, cases::Element element) {
  check_input(material, element);
  const auto points = gauss_points(vertices);
  ShapeGradients mean = ShapeGradients::Zero();
  double volume = 0;
  for (const GaussPoint& point : points) {
    mean += point.volume * point.gradients;
    volume += point.volume;
  }
  mean /= volume;
  const Eigen::Matrix<double, 6, 6> d = elasticity(material);
  ElementStiffness stiffness = ElementStiffness::Zero();
  for (const GaussPoint& point : points) {
    StrainDisplacement b = strain_displacement(point.gradients);
    if (element == cases::Element::q1_bbar) b = with_mean_dilatation(b, mean);
    stiffness += point.volume * b.transpose() * d * b;
  }
  return stiffness;
}

} // namespace springproof::fem_reference
