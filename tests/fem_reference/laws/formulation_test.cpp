#include "fem_reference/laws/formulation.hpp"

#include "mechanics/laws/neo_hookean.hpp"
#include "tests/fem_reference/laws/point_law.hpp"
#include "tests/fem_reference/scenes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace fem_reference;
using namespace point_laws;

namespace {

const auto log_strain = point_law<LogStrain>;
const auto ogden = point_law<Ogden>;
const auto yeoh = point_law<Yeoh>;

struct Named {
  std::string name;
  PointLaw formulation;
};

/// Every formulation; Ogden materials with positive, negative, large and fractional exponents.
std::vector<Named> formulations() {
  const auto elastic = scenes::thesis_elastic();
  return {{"small_strain", point_law<SmallStrain>(elastic)},
          {"saint_venant_kirchhoff", point_law<SaintVenantKirchhoff>(elastic)},
          {"neo_hookean", point_law<AtPoint<mechanics::NeoHookean>>(elastic)},
          {"log_strain", log_strain(elastic)},
          {"small_strain with a fibre", point_law<TransverseSmallStrain>(scenes::fibrous({1, 2, -0.5}))},
          {"log_strain with a fibre", point_law<TransverseLogStrain>(scenes::fibrous({1, 2, -0.5}))},
          {"neo-Hooke", ogden({{0.5}, {2}, 2.})},
          {"Mooney-Rivlin", ogden({{0.3, 0.2}, {2, -2}, 2.})},
          {"Ogden", ogden({{0.1, 0.2, -0.05}, {5.7255, 0.5, -3.}, 2.})},
          {"Yeoh", yeoh({0.2, -0.05, 0.1, 2.})}};
}

Matrix3 turn(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

/// Deformation gradients with these stretches along axes that are nobody's.
Matrix3 with_stretches(double a, double b, double c) {
  return turn(0.4) * turn(1.1).transpose() * Eigen::Vector3d(a, b, c).asDiagonal() * turn(-0.7);
}

const std::vector<std::pair<std::string, Matrix3>> states{
    {"rest", Matrix3::Identity()},
    {"rotation", turn(0.9)},
    {"uniaxial", with_stretches(1.7, 0.8, 0.8)},
    {"equibiaxial", with_stretches(1.4, 1.4, 0.6)},
    {"dilatation", with_stretches(1.2, 1.2, 1.2)},
    {"three stretches", with_stretches(0.5, 2, 1.1)},
    {"stretches 1e-12 apart", with_stretches(1.3, 1.3 + 1e-12, 0.7)},
    {"stretches 1e-8 apart", with_stretches(1.3, 1.3 + 1e-8, 0.7)},
    {"stretches 1e-5 apart", with_stretches(1.3, 1.3 + 1e-5, 0.7)},
    {"stretches 1e-3 apart", with_stretches(1.3, 1.301, 0.7)}};

} // namespace

TEST_CASE("the stress tangent is the stress's derivative, where stretches coincide and where they nearly do",
          "[verification]") {
  for (const auto& [name, law] : formulations())
    for (const auto& [state, f] : states) {
      const Matrix9 tangent = whole_tangent(law, f);
      Matrix9 differences;
      const double step = 1e-5; // truncation step² ~ 1e-10, rounding 1e-16/step ~ 1e-11
      for (int k = 0; k < 9; ++k) {
        Matrix3 forward = f, backward = f;
        forward(k / 3, k % 3) += step;
        backward(k / 3, k % 3) -= step;
        differences.col(k) = (whole_stress(law, forward) - whole_stress(law, backward)) / (2 * step);
      }
      CAPTURE(name, state);
      CHECK((tangent - differences).norm() <= 1e-8 * tangent.norm()); // 10 times the larger of both
    }
}

TEST_CASE("the stress is the derivative of the energy, where there is one", "[verification]") {
  int n_laws = 0;
  for (const auto& [name, law] : formulations()) {
    if (law.symmetry == TangentSymmetry::unsymmetric) continue;
    ++n_laws;
    for (const auto& [state, f] : states) {
      Vector9 differences;
      const double step = 1e-3; // fourth order: truncation step⁴ times exponents to the fifth over 30 ~ 1e-10
      for (int k = 0; k < 9; ++k) {
        // clang 14 captures no names of structured bindings
        const auto energy = [&, &f = f, &law = law](double steps) {
          Matrix3 moved = f;
          moved(k / 3, k % 3) += steps * step;
          return law.energy(moved);
        };
        differences[k] = (8 * (energy(1) - energy(-1)) - (energy(2) - energy(-2))) / (12 * step);
      }
      CAPTURE(name, state);
      CHECK((whole_stress(law, f) - differences).norm() <= 1e-8 * whole_tangent(law, f).norm());
    }
    CHECK(std::abs(law.energy(Matrix3::Identity())) <= 1e-28);
    if (law.kinematics == Kinematics::finite) CHECK(law.energy(turn(0.8)) <= 1e-14); // rounding
  }
  CHECK(n_laws == 8);
}

TEST_CASE("the energy of log_strain is the work on the straight path of logarithmic strain",
          "[verification]") {
  const cases::TransverselyIsotropic fibrous = scenes::fibrous({1, 2, -0.5});
  const bool has_fibre = GENERATE(false, true);
  const PointLaw law =
      has_fibre ? point_law<TransverseLogStrain>(fibrous) : log_strain(scenes::thesis_elastic());
  const PointLaw hooke = has_fibre ? point_law<TransverseSmallStrain>(fibrous)
                                   : point_law<SmallStrain>(scenes::thesis_elastic());
  const Eigen::Vector3d log(0.4, -0.5, 0.2);
  const auto at = [&](double s) {
    const Eigen::Vector3d stretch = (s * log).array().exp();
    return with_stretches(stretch[0], stretch[1], stretch[2]);
  };
  double work = 0;
  const int n = 2000; // midpoint rule: 1/(24 n²) ~ 1e-8 of it
  for (int i = 0; i < n; ++i) {
    const double s = (i + 0.5) / n, h = 0.5 / n;
    const Matrix3 change = at(s + h) - at(s - h);
    work += whole_stress(law, at(s)).dot(flatten(change));
  }
  CHECK(law.energy(at(1)) == Approx(work).epsilon(1e-6));
  // the energy at small strains agrees with that of Hooke's law in the leading digits
  const Matrix3 small = Matrix3::Identity() + 1e-7 * Eigen::Vector3d(1, -2, 3).asDiagonal().toDenseMatrix();
  CHECK(law.energy(small) == Approx(hooke.energy(small)).epsilon(1e-5));
}

TEST_CASE("the tangent of a material with an energy is symmetric, that of log_strain is not",
          "[verification]") {
  for (const auto& [name, law] : formulations()) {
    const Matrix9 tangent = whole_tangent(law, with_stretches(0.5, 2, 1.1));
    const double skew = (tangent - tangent.transpose()).norm() / tangent.norm();
    CAPTURE(name, skew);
    if (law.symmetry == TangentSymmetry::symmetric) CHECK(skew <= 1e-13); // rounding error
    if (law.symmetry == TangentSymmetry::unsymmetric) CHECK(skew > 1e-3); // no accident of rounding
  }
}

TEST_CASE("a superposed rotation turns the stress and changes nothing else", "[verification]") {
  for (const auto& [name, law] : formulations()) {
    if (law.kinematics == Kinematics::linear)
      continue; // small strain is not frame indifferent, by definition
    for (const auto& [state, f] : states) {
      const Matrix3 q = turn(2.2);
      const Vector9 plain = whole_stress(law, f), turned = whole_stress(law, q * f);
      const Matrix3 expected =
          q * Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(plain.data());
      CAPTURE(name, state);
      CHECK((turned - flatten(expected)).norm() <=
            1e-13 * whole_tangent(law, f).norm()); // rounding of F's entries
    }
  }
}

TEST_CASE("every law has the moduli of linear elasticity at rest", "[verification]") {
  const auto fibrous = scenes::fibrous({1, 2, -0.5});
  const Matrix9 of_fibrous = whole_tangent(point_law<TransverseSmallStrain>(fibrous), Matrix3::Identity());
  CHECK((whole_tangent(point_law<TransverseLogStrain>(fibrous), Matrix3::Identity()) - of_fibrous).norm() <=
        1e-13 * of_fibrous.norm()); // rounding error
  const double mu = 0.4, kappa = 1.7;
  const cases::LinearElastic elastic{9 * kappa * mu / (3 * kappa + mu),
                                     (3 * kappa - 2 * mu) / (6 * kappa + 2 * mu)};
  const Matrix9 linear = whole_tangent(point_law<SmallStrain>(elastic), Matrix3::Identity());
  for (const auto& finite :
       {point_law<SaintVenantKirchhoff>(elastic), log_strain(elastic), ogden({{mu}, {2}, kappa}),
        ogden({{0.5, -0.1}, {5, -2.5}, kappa}), yeoh({mu / 2, 0.3, -0.1, kappa})})
    CHECK((whole_tangent(finite, Matrix3::Identity()) - linear).norm() <=
          1e-13 * linear.norm()); // rounding error
}

TEST_CASE("Yeoh's law of two terms is Ogden's of three", "[verification]") {
  // (l1² + l2² + l3²)² = l1⁴ + l2⁴ + l3⁴ + 2 (l1^-2 + l2^-2 + l3^-2) of isochoric stretches
  const double c10 = 0.2, c20 = -0.05;
  const PointLaw two = yeoh({c10, c20, 0, 2.}),
                 three = ogden({{2 * c10 - 12 * c20, 8 * c20, 4 * c20}, {2, 4, -2}, 2.});
  for (const auto& [state, f] : states) {
    CAPTURE(state);
    const Matrix9 tangent = whole_tangent(three, f);
    CHECK((whole_stress(two, f) - whole_stress(three, f)).norm() <= 1e-13 * tangent.norm()); // rounding
    CHECK((whole_tangent(two, f) - tangent).norm() <= 1e-13 * tangent.norm());
  }
}

TEST_CASE("log_strain is Hooke's law between Cauchy stress and the logarithm of the left stretch",
          "[verification]") {
  const auto elastic = scenes::thesis_elastic();
  const auto [lambda, mu, kappa] = mechanics::elastic_moduli(elastic);
  const Matrix3 f = with_stretches(0.5, 2, 1.1);
  const Eigen::SelfAdjointEigenSolver<Matrix3> left(f * f.transpose());
  const Matrix3 strain = left.eigenvectors() *
                         (0.5 * left.eigenvalues().array().log()).matrix().asDiagonal() *
                         left.eigenvectors().transpose();
  const Matrix3 cauchy = lambda * strain.trace() * Matrix3::Identity() + 2 * mu * strain;
  const Matrix3 first = f.determinant() * cauchy * f.inverse().transpose();
  CHECK((whole_stress(log_strain(elastic), f) - flatten(first)).norm() <=
        1e-13 * first.norm()); // rounding error
}

TEST_CASE("the dilatation of a pressure is the inverse of the pressure of a dilatation") {
  int n_laws = 0;
  for (const auto& [name, law] : formulations()) {
    if (!law.pressure) continue;
    ++n_laws;
    for (const double change : {-0.8, -0.1, -1e-12, 0., 1e-12, 0.0001, 2.}) {
      const ValueAndSlope p = law.pressure(change), back = law.dilatation(p.value);
      CAPTURE(name, change);
      CHECK(std::abs(back.value - change) <= 2e-14 * std::abs(change)); // rounding error
      CHECK(std::abs(back.slope * p.slope - 1) <= 1e-13);               // derivative of the inverse
    }
  }
  CHECK(n_laws >= 3); // those with an Ogden energy
}

TEST_CASE("the ratio of hyperbolic sines has no gap where its series begins") {
  for (const double a : {0.5, -1.5, 2.86275, 10.}) {
    CHECK(mechanics::sinh_ratio(a, 0.) == a);
    const double below = mechanics::sinh_ratio(a, 0.999999e-3), above = mechanics::sinh_ratio(a, 1.000001e-3);
    CHECK(std::abs(below - above) <=
          1e-11 * std::abs(a) * (1 + a * a)); // slope a³ d/3 times 2e-9, and rounding
  }
}

TEST_CASE("a formulation refuses a material that is not its own") {
  cases::Fem fem;
  fem.formulation = cases::Formulation::hyperelastic;
  CHECK_THROWS_AS(make_formulation(fem, scenes::thesis_elastic()), cases::InputError);
  fem.formulation = cases::Formulation::log_strain;
  CHECK_THROWS_AS(make_formulation(fem, scenes::thesis_ogden()), cases::InputError);
}
