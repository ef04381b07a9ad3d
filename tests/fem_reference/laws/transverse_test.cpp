#include "mechanics/dense.hpp"
#include "tests/fem_reference/laws/point_law.hpp"
#include "tests/fem_reference/scenes.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

using namespace point_laws;
using Eigen::Vector3d;

namespace {

const cases::TransverselyIsotropic fibrous_body = scenes::fibrous(Vector3d(1, 2, -0.5));
constexpr double contraction_along = 0.4 * 0.1 / 0.3; ///< contraction along the fibre when pulled across it

Matrix3 turned_by(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

/// Columns: the fibre and two directions across it.
Matrix3 fibre_axes(const cases::TransverselyIsotropic& material) {
  Matrix3 axes;
  axes.col(0) = material.fibre;
  axes.col(1) = material.fibre.unitOrthogonal();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// The stretch of these logarithmic strains along the axes.
Matrix3 stretch_of(const Matrix3& axes, const Vector3d& strains) {
  return axes * Vector3d(strains.array().exp()).asDiagonal() * axes.transpose();
}

/// Cauchy stress of a first Piola-Kirchhoff stress.
Matrix3 cauchy_stress(const Vector9& first, const Matrix3& f) {
  return Matrix3(first.reshaped<Eigen::RowMajor>(3, 3)) * f.transpose() / f.determinant();
}

} // namespace

TEST_CASE("a transversely isotropic material of isotropic constants has the isotropic laws",
          "[verification]") {
  const cases::LinearElastic isotropic{0.3, 0.35};
  const cases::TransverselyIsotropic same{0.3, 0.3, 0.35, 0.35, 0.3 / 2.7, Vector3d(2, -1, 3).normalized()};
  const auto compare = [](const PointLaw& a, const PointLaw& b, const Matrix3& f) {
    CHECK((whole_stress(a, f) - whole_stress(b, f)).norm() <= 1e-12 * whole_tangent(b, f).norm());
    CHECK((whole_tangent(a, f) - whole_tangent(b, f)).norm() <= 1e-12 * whole_tangent(b, f).norm());
    // the part that averaged elements average, too
    CHECK(std::abs(a.pressure(0.3).value / b.pressure(0.3).value - 1) <= 1e-12);
    CHECK(std::abs(a.dilatation(0.1).value / b.dilatation(0.1).value - 1) <= 1e-12);
  };
  for (const Vector3d& stretches : {Vector3d(1, 1, 1), Vector3d(0.5, 2, 1.1), Vector3d(1.4, 1.4, 0.6),
                                    Vector3d(1.3, 1.3 + 1e-9, 0.7), Vector3d(1.2, 1.2, 1.2)}) {
    const Matrix3 f = turned_by(0.4) * stretches.asDiagonal() * turned_by(-0.7);
    CAPTURE(stretches.transpose());
    compare(point_law<TransverseSmallStrain>(same), point_law<SmallStrain>(isotropic), f);
    compare(point_law<TransverseLogStrain>(same), point_law<LogStrain>(isotropic), f);
  }
}

TEST_CASE(
    "pulled along or across its fibre a material has Young's modulus and Poisson's ratios of that direction",
    "[verification]") {
  const Matrix3 axes = fibre_axes(fibrous_body);
  const auto& m = fibrous_body;
  struct Pull {
    int direction;
    double modulus;
    Vector3d strains; ///< relative to the axial strain
  };
  const Pull along{0, m.youngs_modulus_along, {1, -m.poissons_ratio_along, -m.poissons_ratio_along}},
      across{1, m.youngs_modulus_across, {-contraction_along, 1, -m.poissons_ratio_across}};
  for (const Pull& pull : {along, across})
    for (const double strain : {-0.5, -0.01, 0.2, 0.7}) {
      const Vector3d pulled = axes.col(pull.direction);
      const Matrix3 expected = pull.modulus * strain * pulled * pulled.transpose();
      CAPTURE(pull.direction, strain);
      const Matrix3 small = axes * Vector3d(strain * pull.strains).asDiagonal() * axes.transpose();
      CHECK(
          (whole_stress(point_law<TransverseSmallStrain>(m), Matrix3::Identity() + small) - flatten(expected))
              .norm() <= 1e-13); // rounding error, in MPa, of moduli of 0.1 to 1
      // logarithmic strain: the Cauchy stress is E times the strain, whatever the rotation
      const Matrix3 f = turned_by(1.2) * stretch_of(axes, strain * pull.strains);
      CHECK((cauchy_stress(whole_stress(point_law<TransverseLogStrain>(m), f), f) -
             turned_by(1.2) * expected * turned_by(1.2).transpose())
                .norm() <= 1e-13);
    }
}

TEST_CASE("a small shear along the fibre meets one modulus, across it the other", "[verification]") {
  const Matrix3 axes = fibre_axes(fibrous_body);
  const double across = fibrous_body.youngs_modulus_across / (2 * (1 + fibrous_body.poissons_ratio_across));
  const auto modulus = [&](int i, int j) {
    Matrix3 shear = Matrix3::Zero();
    shear(i, j) = 1;
    const Vector9 direction = flatten(axes * shear * axes.transpose());
    return std::array<double, 2>{
        direction.dot(whole_tangent(point_law<TransverseSmallStrain>(fibrous_body), Matrix3::Identity()) *
                      direction),
        direction.dot(whole_tangent(point_law<TransverseLogStrain>(fibrous_body), Matrix3::Identity()) *
                      direction)};
  };
  for (const double found : modulus(0, 1)) CHECK(std::abs(found - fibrous_body.shear_modulus_along) <= 1e-13);
  for (const double found : modulus(2, 0)) CHECK(std::abs(found - fibrous_body.shear_modulus_along) <= 1e-13);
  for (const double found : modulus(1, 2)) CHECK(std::abs(found - across) <= 1e-13);
}

TEST_CASE("a body and its fibre turned together have the turned stress", "[verification]") {
  const Matrix3 q = turned_by(2.2),
                f = turned_by(0.4) * Vector3d(0.6, 1.7, 1.1).asDiagonal() * turned_by(-0.7);
  cases::TransverselyIsotropic turned = fibrous_body;
  turned.fibre = q * fibrous_body.fibre;
  const auto check = [&](const PointLaw& law, const PointLaw& of_turned) {
    const Matrix3 plain = whole_stress(law, f).reshaped<Eigen::RowMajor>(3, 3);
    const Vector9 found = whole_stress(of_turned, q * f * q.transpose());
    CHECK((found - flatten(q * plain * q.transpose())).norm() <= 1e-13 * plain.norm());
    // the fibre is no ornament: left where it was, it gives another stress
    CHECK((whole_stress(law, q * f * q.transpose()) - found).norm() > 0.1 * plain.norm());
  };
  check(point_law<TransverseSmallStrain>(fibrous_body), point_law<TransverseSmallStrain>(turned));
  check(point_law<TransverseLogStrain>(fibrous_body), point_law<TransverseLogStrain>(turned));
}

TEST_CASE("up to the bounds of Poisson's ratios every strain stores energy, beyond them one does not",
          "[verification]") {
  const auto lowest = [](const cases::TransverselyIsotropic& m) {
    const mechanics::TransverseModuli c = mechanics::transverse_moduli(m);
    Matrix3 normal;
    normal << c.c11, c.c12, c.c13, c.c12, c.c11, c.c13, c.c13, c.c13, c.c33;
    return mechanics::eigenvalues(normal)[0];
  };
  cases::TransverselyIsotropic m = fibrous_body;
  const double bound =
      std::sqrt((1 - m.poissons_ratio_across) * m.youngs_modulus_along / (2 * m.youngs_modulus_across));
  for (const double sign : {-1., 1.}) {
    m.poissons_ratio_along = sign * bound * (1 - 1e-6);
    CHECK(lowest(m) > 0);
    m.poissons_ratio_along = sign * bound * (1 + 1e-6);
    CHECK(lowest(m) < 0);
  }
}

TEST_CASE("what averaged elements take point by point stays bounded when the volume is kept",
          "[verification]") {
  const auto split = [](double distance) { // distance from keeping the volume
    cases::TransverselyIsotropic m = fibrous_body;
    m.poissons_ratio_along = 0.5 - distance;
    m.poissons_ratio_across = 1 - m.youngs_modulus_across / (2 * m.youngs_modulus_along) - distance;
    return TransverseElasticity(m);
  };
  const TransverseElasticity near = split(1e-4), nearer = split(1e-6);
  CHECK(std::abs(nearer.kappa() / near.kappa() / 100 - 1) <= 1e-6); // 1/kappa is linear in the distance
  CHECK((nearer.rest() - near.rest()).norm() <= 1e-2 * near.rest().norm());
  const Eigen::VectorXd eigenvalues = mechanics::eigenvalues(nearer.rest());
  CHECK(eigenvalues[0] >= -1e-9 * eigenvalues[8]); // rounding error of kappa
}

TEST_CASE("divided differences of the logarithm are exact where arguments meet", "[verification]") {
  CHECK(divided_difference(2., 2.) == 0.25);
  CHECK(std::abs(divided_difference(2, 2, 2) + 0.0625) <= 1e-16); // f''/2 of ln(x)/2
  CHECK(std::abs(divided_difference(4., 1.) - std::log(2) / 3) <= 1e-16);
  CHECK(std::abs(divided_difference(1, 1, std::exp(2)) - (1 / (std::exp(2) - 1) - 0.5) / (std::exp(2) - 1)) <=
        1e-15);
  for (const double ratio : {0., 0.3, 0.5, 1.}) {           // the middle argument, between the others
    const double end = 0.02 / (1 - 0.02 * (1 + ratio) / 3); // the series' end: a spread of 0.02 of the mean
    const auto at = [&](double spread) { return divided_difference(1, 1 + ratio * spread, 1 + spread); };
    // the function itself changes by 1e-14, the quotient has the rounding error 1e-16/0.02
    CHECK(std::abs(at(end * (1 + 1e-12)) - at(end * (1 - 1e-12))) <= 1e-13);
  }
}
