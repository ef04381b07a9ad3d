#include "fem_reference/element_stiffness.hpp"

#include "cases/case/error.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "mechanics/hexahedron.hpp"

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

std::array<GaussPoint, 8> gauss_points(const std::array<Eigen::Vector3d, 8>& vertices) {
  std::array<GaussPoint, 8> points;
  for (int q = 0; q < 8; ++q) {
    const Eigen::Vector3d at = mechanics::gauss_point(q);
    const Eigen::Matrix3d jacobian = mechanics::jacobian(vertices, at);
    const double determinant = jacobian.determinant();
    if (!(determinant > 0))
      throw cases::InputError("the cell is inverted or degenerate: its Jacobian determinant is " +
                              std::to_string(determinant / 8) + " mm³ at a Gauss point; it must be positive");
    points[static_cast<std::size_t>(q)] = {jacobian.inverse().transpose() * mechanics::shape_gradients(at),
                                           determinant / 8};
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
  const auto [lambda, mu, kappa] = mechanics::elastic_moduli(material);
  Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
  d.topLeftCorner<3, 3>().setConstant(lambda);
  d.diagonal() << Eigen::Vector3d::Constant(lambda + 2 * mu), Eigen::Vector3d::Constant(mu);
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
