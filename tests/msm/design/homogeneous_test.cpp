
#include "mechanics/dense.hpp"
#include "msm/design/cells.hpp"
#include "msm/tangent.hpp"
#include "tests/support/closed_forms.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

using namespace springproof;

namespace {

const msm::CellStiffness plain_springs = {0.031, 0.047, 0.033, 0};
const msm::CellStiffness springs_and_volume = {0.05, 0.01, 0.04, 0.3};
const msm::CellStiffness power_log = {0.05, 0.01, 0.04, 0.3, msm::Exponents{-1.3, -2, 1.8}};
const msm::CellStiffness with_midlines = {0.05, 0.01, 0.04, 0.3, msm::Exponents{-1.3, -2, 1.8}, 0.12};
const double cell_edge = 1.3;

Eigen::Matrix3d some_deformation() {
  Eigen::Matrix3d f;
  f << 1.2, 0.3, -0.1, 0.05, 0.9, 0.2, 0.1, -0.15, 1.1;
  return f;
}

} // namespace

TEST_CASE("a lattice block's energy per volume is the closed form", "[verification]") {
  for (const msm::CellStiffness& stiffness : {plain_springs, springs_and_volume, power_log, with_midlines}) {
    const int n = 3;
    const msm::Lattice lattice = msm::make_lattice(
        cases::make_box_mesh(Eigen::Vector3d::Constant(n * cell_edge), {{n, n, n}}), {stiffness});
    msm::Points positions = lattice.rest;
    for (Eigen::Vector3d& x : positions) x = some_deformation() * x;
    const double expected = msm::energy(lattice, positions) / std::pow(n * cell_edge, 3);
    const double energy = msm::lattice_energy_density(stiffness, cell_edge, some_deformation());
    CHECK(energy == Approx(expected).epsilon(1e-13)); // the same sums in another order
  }
}

TEST_CASE("the lattice's stress is the derivative of its energy", "[verification]") {
  const Eigen::Matrix3d f = some_deformation();
  for (const msm::CellStiffness& stiffness : {plain_springs, springs_and_volume, power_log, with_midlines}) {
    const Eigen::Matrix3d stress = msm::lattice_stress(stiffness, cell_edge, f);
    const double h = 1e-5;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        Eigen::Matrix3d above = f, below = f;
        above(i, j) += h;
        below(i, j) -= h;
        const double slope = (msm::lattice_energy_density(stiffness, cell_edge, above) -
                              msm::lattice_energy_density(stiffness, cell_edge, below)) /
                             (2 * h);
        CHECK(slope == Approx(stress(i, j)).margin(1e-8)); // h² and round-off / h of energies near 0.1 MPa
      }
  }
}

TEST_CASE("homogeneous energy and stress of power-log springs turn with the lattice") {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(1.9, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Eigen::Matrix3d f = some_deformation();
  CHECK(msm::lattice_energy_density(power_log, cell_edge, rotation * f) ==
        Approx(msm::lattice_energy_density(power_log, cell_edge, f)).epsilon(1e-13)); // rounding
  CHECK((msm::lattice_stress(power_log, cell_edge, rotation * f) -
         rotation * msm::lattice_stress(power_log, cell_edge, f))
            .norm() < 1e-15);
}

namespace {

/// c of the nominal stress E (e + c e² + ...) along a lattice axis with free sides.
double second_order_coefficient(const msm::CellStiffness& stiffness) {
  const double e = 1e-3;
  const auto stress = [&](double strain) {
    const double lateral = msm::free_lateral_stretch(stiffness, 1, 1 + strain);
    return msm::lattice_stress(stiffness, 1, Eigen::Vector3d(lateral, lateral, 1 + strain).asDiagonal())(2,
                                                                                                         2);
  };
  return (stress(e) + stress(-e)) / (stress(e) - stress(-e)) / e;
}

} // namespace

TEST_CASE("power-log springs curve the uniaxial stress as an independent program finds it",
          "[verification]") {
  // Cauchy stress E ln(stretch), contraction nu ln(stretch): c = -(1/2 + 2 nu). The exponents that give it
  // were found by root search elsewhere, for springs with a volume term of the material's moduli and t = 0.8.
  const std::pair<double, double> found[] = {
      {0.25, -1.380}, {0.3, -1.443}, {0.35, -1.485}, {0.45, -1.522}, {0.49, -1.528}};
  const auto with = [](double nu, double p) {
    const double mu = 1 / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu), t = 0.8;
    return msm::CellStiffness{(1 + t) * mu / 4, (1 - t) * mu / 2, 0.75 * t * mu, lambda - mu,
                              msm::Exponents{p, p, p}};
  };
  for (const auto& [nu, p] : found) {
    const double c = second_order_coefficient(with(nu, p));
    CHECK(c ==
          Approx(-(0.5 + 2 * nu)).margin(1.5e-3)); // p has three decimals, c grows by 1.4 to 2 times as much
    // linear in p
    const double low = second_order_coefficient(with(nu, -2)), high = second_order_coefficient(with(nu, 2));
    CHECK(second_order_coefficient(with(nu, 0)) ==
          Approx((low + high) / 2).margin(1e-4)); // e² of the differences
  }
}

TEST_CASE("sides are free of stress at the free lateral stretch") {
  const double lateral = msm::free_lateral_stretch(springs_and_volume, cell_edge, 1.3);
  const Eigen::Matrix3d f = Eigen::Vector3d(lateral, lateral, 1.3).asDiagonal();
  CHECK(std::abs(msm::lattice_stress(springs_and_volume, cell_edge, f)(0, 0)) <=
        1e-12); // MPa, of stresses near 0.1: bisected to round-off
}

TEST_CASE("long waves at rest have the stiffness of the softest acoustic wave of the moduli",
          "[verification]") {
  // An isotropic lattice: the shear waves, mu |q|² per volume: times h³/h² = mu h. Shorter waves are softer:
  // 4 sin²(q/2) < q².
  const double mu = 0.1, split = 0.6;
  const msm::CellStiffness isotropic = {(1 - split) * mu / 4 + 2 * 0.75 * split * mu * 2 / 3 / 2,
                                        (1 - split) * mu / 2, 0.75 * split * mu, 0.2};
  REQUIRE(closed::lattice_moduli(isotropic, 1).zener == Approx(1));
  const double smallest = msm::smallest_wave_stiffness(isotropic, 1, Eigen::Matrix3d::Identity());
  CHECK(smallest > 0);
  CHECK(smallest < mu); // the zone's boundary
  CHECK(smallest > 0.05 * mu);
}

TEST_CASE("waves have the stiffness that the tangent of a block of the lattice gives them",
          "[verification]") {
  const Eigen::Matrix3d f = some_deformation();
  for (const msm::CellStiffness& stiffness : {plain_springs, springs_and_volume, power_log, with_midlines}) {
    const msm::Lattice block = msm::make_lattice(
        cases::make_box_mesh(Eigen::Vector3d::Constant(2 * cell_edge), {{2, 2, 2}}), {stiffness});
    msm::Points positions = block.rest;
    for (Eigen::Vector3d& x : positions) x = f * x;
    Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(81, 81);
    msm::visit_tangent_blocks(block, positions, msm::Clamp::no,
                              [&](int i, int j, const Eigen::Matrix3d& part) {
                                tangent.block<3, 3>(3 * i, 3 * j) += part;
                                if (i != j) tangent.block<3, 3>(3 * j, 3 * i) += part.transpose();
                              });
    const auto stiffness_of = [&](const Eigen::Vector3d& phase) {
      Eigen::Matrix3cd sum = Eigen::Matrix3cd::Zero();
      for (int n = 0; n < 27; ++n) {
        const auto at = static_cast<std::size_t>(n);
        const Eigen::Vector3d cells =
            (block.rest[at] - block.rest[13]) / cell_edge; // place relative to the block's centre
        sum += tangent.block<3, 3>(39, 3 * n) * std::polar(1.0, phase.dot(cells));
      }
      Eigen::Matrix<double, 6, 6> real; // has each eigenvalue twice
      real << sum.real(), -sum.imag(), sum.imag(), sum.real();
      return mechanics::eigenvalues(real)[0] / phase.squaredNorm();
    };
    double smallest = INFINITY; // the waves sampled: pi/4 apart, and long ones
    for (int i = -4; i <= 4; ++i)
      for (int j = -4; j <= 4; ++j)
        for (int k = -4; k <= 4; ++k) {
          const Eigen::Vector3d q(i, j, k);
          if (q.squaredNorm() == 0) continue;
          smallest = std::min({smallest, stiffness_of(q * M_PI / 4), stiffness_of(0.01 * q.normalized())});
        }
    CHECK(msm::smallest_wave_stiffness(stiffness, cell_edge, f) ==
          Approx(smallest).margin(1e-11)); // N/mm; rounding of 0.1 over 0.01²
  }
}

TEST_CASE("a lattice without diagonals has waves without stiffness, and none of its deformations is stable") {
  const msm::CellStiffness edges_only = {0.05, 0, 0, 0};
  CHECK(std::abs(msm::smallest_wave_stiffness(edges_only, 1, Eigen::Matrix3d::Identity())) <=
        1e-12); // exactly none
  const msm::StabilityRange range = msm::stability_range(edges_only, 1);
  CHECK(range.shear == 0);
}

TEST_CASE("at the end of the stability range a wave has just no stiffness left") {
  const msm::StabilityRange range = msm::stability_range(plain_springs, 1);
  CHECK(range.stretch > 1);
  CHECK(range.compression < 1);
  CHECK(range.shear > 0);
  const auto smallest = [](double stretch) {
    const double lateral = msm::free_lateral_stretch(plain_springs, 1, stretch);
    return msm::smallest_wave_stiffness(plain_springs, 1,
                                        Eigen::Vector3d(lateral, lateral, stretch).asDiagonal());
  };
  REQUIRE(range.compression > msm::search_ends.compression);
  CHECK(smallest(range.compression + 2e-4) > 0); // bisected to 1e-4
  CHECK_FALSE(smallest(range.compression - 2e-4) > 0);
}

TEST_CASE("a volume term widens the range of stable compression") {
  const msm::CellStiffness soft = {0.0233, 0.0065, 0.0227, 0};
  msm::CellStiffness with_volume = soft;
  with_volume.volume = 5;
  CHECK(msm::stability_range(with_volume, 1).compression < msm::stability_range(soft, 1).compression);
}
