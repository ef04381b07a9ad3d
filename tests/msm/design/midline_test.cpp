#include "msm/design/midline.hpp"

#include "msm/design/design.hpp"
#include "msm/tangent.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::Design;
using cases::index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double youngs_modulus = 0.3; // MPa
const std::vector<double> ratios{0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.49};

msm::DesignResult designed(Design design, double nu, std::optional<double> beta = {},
                           const msm::CellVertices& cell = msm::cube(1)) {
  msm::DesignRequest request;
  request.material = cases::LinearElastic{youngs_modulus, nu};
  request.cell = cell;
  request.options.design = design;
  request.options.beta = beta;
  if (design == Design::midline) request.options.law = cases::SpringLaw::power_log;
  return msm::design(request);
}

/// E I, N mm², of a free bar whose square section has n x n cells of 1 mm, bent by end moments: the energy of
/// one layer of cells under curvature 1, the same section beside each of its ends, whose shape is free.
double bending_stiffness_of_bar(const msm::SpringBody& springs, int n) {
  const cases::Mesh mesh = cases::make_box_mesh(Vector3d(n, n, 1), {n, n, 1});
  const msm::Lattice lattice = msm::make_lattice(mesh, springs);
  const int n_nodes = (n + 1) * (n + 1);
  MatrixXd k = MatrixXd::Zero(6 * n_nodes, 6 * n_nodes);
  msm::visit_tangent_blocks(lattice, lattice.rest, msm::Clamp::no,
                            [&](int row, int column, const Eigen::Matrix3d& block) {
                              k.block<3, 3>(3 * row, 3 * column) += block;
                              if (row != column) k.block<3, 3>(3 * column, 3 * row) += block.transpose();
                            });
  VectorXd bent = VectorXd::Zero(6 * n_nodes);
  MatrixXd same_on_both = MatrixXd::Zero(6 * n_nodes, 3 * n_nodes);
  for (int p = 0; p < 2 * n_nodes; ++p) {
    const Vector3d at = lattice.rest[index(p)] - Vector3d(n / 2., n / 2., 0);
    bent.segment<3>(3 * p) = Vector3d(-at.z() * at.z() / 2, 0, at.x() * at.z());
    same_on_both.block<3, 3>(3 * p, 3 * (p % n_nodes)).setIdentity();
  }
  const MatrixXd of_shape = same_on_both.transpose() * k * same_on_both;
  const VectorXd right_side = -same_on_both.transpose() * (k * bent);
  const VectorXd shape = of_shape.completeOrthogonalDecomposition().solve(right_side);
  const VectorXd whole = bent + same_on_both * shape;
  return whole.dot(k * whole);
}

/// H(a_n, b_n)/m: docs/developing/design-theory.md.
double closed_form(double nu, double split, double r, int n) {
  const double m = (1 + nu) / 3, f = 1 - split, b = r * (1 + split) / 2, of_cell = 1. / (n * n);
  const double a_n = (1 - of_cell) * (1 + nu) / (3 * (1 - nu)) + of_cell * (b + f),
               b_n = (1 - of_cell) / 3 + of_cell * b;
  return 2 * a_n * b_n / (a_n + b_n) / m;
}

double exact_bending_stiffness(int n) {
  return youngs_modulus * std::pow(n, 4) / 12;
}

} // namespace

TEST_CASE("a free bar of one cell across bends exactly, of two and three as the closed form says",
          "[verification]") {
  for (const double nu : ratios) {
    CAPTURE(nu);
    const msm::DesignResult midline = designed(Design::midline, nu, 1);
    const auto ratio = [&](int n) {
      return bending_stiffness_of_bar(midline.springs, n) / exact_bending_stiffness(n);
    };
    const double r = msm::edge_part(nu, 0.8, 1);
    CHECK(ratio(1) == Approx(1).epsilon(1e-10));
    CHECK(ratio(2) == Approx(closed_form(nu, 0.8, r, 2)).epsilon(1e-4)); // it neglects the section's corners
    CHECK(ratio(3) == Approx(closed_form(nu, 0.8, r, 3)).epsilon(1e-3));
    CHECK(std::abs(ratio(2) - 1) < 0.0185);
    CHECK(std::abs(ratio(3) - 1) < 0.0185);
    const double hybrid =
        bending_stiffness_of_bar(designed(Design::hybrid, nu).springs, 1) / exact_bending_stiffness(1);
    CHECK(hybrid == Approx(closed_form(nu, 0.8, 1, 1)).epsilon(1e-10));
    CHECK(hybrid > 1.9); // what the midlines mend
    CHECK(msm::bending_stiffness(msm::terms_of(midline.stiffness), msm::cube(1), 0, 2) ==
          Approx(1).epsilon(1e-10));
  }
}

TEST_CASE("midlines leave moduli, curves and the stability at rest as they are", "[verification]") {
  for (const double nu : ratios)
    for (const double beta : {0.8, 1.}) {
      CAPTURE(nu, beta);
      const msm::DesignResult matched = designed(Design::matched, nu),
                              midline = designed(Design::midline, nu, beta);
      const msm::CellStiffness &k = matched.stiffness, &own = midline.stiffness;
      CHECK(own.midline > 0);
      CHECK(own.edge + own.midline / 4 == Approx(k.edge).epsilon(1e-15)); // rounding
      CHECK(own.exponents->by_kind == k.exponents->by_kind);
      const msm::Elasticity with = msm::cell_elasticity(own, msm::cube(1)),
                            without = msm::cell_elasticity(k, msm::cube(1));
      CHECK((with - without).norm() < 1e-10 * without.norm());
      Eigen::Matrix3d f;
      f << 1.2, 0.3, -0.1, 0.05, 0.9, 0.2, 0.1, -0.15, 1.1;
      CHECK((msm::lattice_stress(own, 1, f) - msm::lattice_stress(k, 1, f)).norm() <
            1e-10 * msm::lattice_stress(k, 1, f).norm());
      // The wave that both keep: shear by face diagonals alone, from cell to cell.
      const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity();
      CHECK(msm::smallest_wave_stiffness(own, 1, rest) ==
            Approx(msm::smallest_wave_stiffness(k, 1, rest)).epsilon(1e-10));
      if (nu < 0.25) continue; // neither is stable in a uniaxial test: the volume term is negative
      CHECK(msm::stability_range(own, 1).stretch > msm::stability_range(k, 1).stretch);
      CHECK(msm::stability_range(own, 1).compression < msm::stability_range(k, 1).compression);
    }
}

TEST_CASE("the edges' part in a body of many cells is less by beta's rule") {
  CHECK(msm::default_beta(1) == 1);
  CHECK(msm::default_beta(100) == 0.8);
  CHECK(msm::default_beta(2) == Approx(0.85));
  CHECK(msm::edge_part(0.35, 0.8, 0.5) == Approx(msm::edge_part(0.35, 0.8, 1) / 2));
}

TEST_CASE(
    "in cells that are no cubes midlines bring six bars near their bending stiffness, and keep moduli") {
  for (const double nu : {0.25, 0.35, 0.45}) {
    CAPTURE(nu);
    msm::CellVertices box = msm::cube(1);
    for (Vector3d& x : box) x = x.cwiseProduct(Vector3d(1, 1.1, 0.9));
    const msm::DesignResult midline = designed(Design::midline, nu, 1, box),
                            hybrid = designed(Design::hybrid, nu, {}, box);
    const msm::CellTerms &own = midline.springs.terms()->kinds.front(),
                         &before = hybrid.springs.terms()->kinds.front();
    const msm::Elasticity with = msm::cell_elasticity({own}, box),
                          without = msm::cell_elasticity({before}, box);
    CHECK((with - without).norm() < 1e-10 * without.norm());
    for (int fibre = 0; fibre < 3; ++fibre)
      for (const int gradient : {(fibre + 1) % 3, (fibre + 2) % 3}) {
        CAPTURE(fibre, gradient);
        CHECK(std::abs(msm::bending_stiffness(own, box, fibre, gradient) - 1) < 0.2);
        CHECK(msm::bending_stiffness(before, box, fibre, gradient) > 1.5);
      }
  }
}

TEST_CASE("in a material with a fibre midlines have a part of each axis's edges") {
  msm::DesignRequest request;
  request.material = cases::TransverselyIsotropic{0.5, 0.25, 0.3, 0.3, 0.1, Vector3d::UnitZ()};
  request.options.design = Design::transverse;
  const msm::DesignResult transverse = msm::design(request);
  request.options.design = Design::midline;
  request.options.beta = 1;
  const msm::DesignResult midline = msm::design(request);
  const msm::CellTerms &own = midline.springs.terms()->kinds.front(),
                       &before = transverse.springs.terms()->kinds.front();
  REQUIRE(own.midlines.size() == 3);
  CHECK(own.midlines[2].stiffness > 1.5 * own.midlines[0].stiffness); // along the fibre
  CHECK((msm::cell_elasticity({own}, msm::cube(1)) - msm::cell_elasticity({before}, msm::cube(1))).norm() <
        1e-10);
  for (int fibre = 0; fibre < 3; ++fibre)
    for (const int gradient : {(fibre + 1) % 3, (fibre + 2) % 3}) {
      CAPTURE(fibre, gradient);
      CHECK(std::abs(msm::bending_stiffness(own, msm::cube(1), fibre, gradient) - 1) < 0.15);
      CHECK(msm::bending_stiffness(before, msm::cube(1), fibre, gradient) > 1.5);
    }
}
