#include "msm/tetrahedron.hpp"

#include "tests/support/linear_tetrahedron.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace springproof;

using Eigen::Vector3d;
using msm::TetrahedronPositions;

namespace {

constexpr double soft_lambda = 0.7, soft_mu = 0.3; // MPa

const TetrahedronPositions slanted{Vector3d(0.1, 0, 0.2), Vector3d(1.3, 0.1, 0), Vector3d(0.2, 0.9, -0.1),
                                   Vector3d(0, 0.3, 1.1)};

/// The slanted tetrahedron, stretched by a fifth, sheared and turned.
TetrahedronPositions deformed() {
  Eigen::Matrix3d f;
  f << 1.2, 0.3, -0.1, 0.05, 0.8, 0.2, 0.1, -0.15, 1.1;
  TetrahedronPositions x = slanted;
  for (Vector3d& point : x) point = f * point + Vector3d(0, 2, -1);
  return x;
}

msm::EdgeValues lengths_at_rest() {
  msm::EdgeValues slanted_lengths;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [a, b] = msm::tetrahedron_edges[e];
    slanted_lengths[static_cast<Eigen::Index>(e)] =
        (slanted[static_cast<std::size_t>(b)] - slanted[static_cast<std::size_t>(a)]).norm();
  }
  return slanted_lengths;
}

const msm::EdgeValues slanted_lengths = lengths_at_rest();
const msm::EdgeMatrix slanted_stiffness = msm::biquadratic_stiffness(slanted, soft_lambda, soft_mu);

} // namespace

TEST_CASE("biquadratic springs store what a linear St. Venant-Kirchhoff tetrahedron stores",
          "[verification]") {
  const TetrahedronPositions x = deformed();
  // The same number by strains and by lengths: round-off.
  CHECK(msm::biquadratic_energy(x, slanted_lengths, slanted_stiffness) ==
        Approx(linear_tetrahedron::energy(slanted, x, soft_lambda, soft_mu)).epsilon(1e-13));
  const auto forces = msm::biquadratic_forces(x, slanted_lengths, slanted_stiffness),
             expected = linear_tetrahedron::forces(slanted, x, soft_lambda, soft_mu);
  for (std::size_t v = 0; v < 4; ++v) CHECK((forces[v] - expected[v]).norm() <= 1e-14); // N, of 0.1
}

TEST_CASE("the tensions of a tetrahedron's edges add up to its forces", "[verification]") {
  const TetrahedronPositions x = deformed();
  const auto forces = msm::biquadratic_forces(x, slanted_lengths, slanted_stiffness);
  const msm::EdgeValues tensions = msm::biquadratic_tensions(x, slanted_lengths, slanted_stiffness);
  TetrahedronPositions pulls;
  pulls.fill(Vector3d::Zero());
  for (std::size_t e = 0; e < 6; ++e) {
    const auto from = static_cast<std::size_t>(msm::tetrahedron_edges[e][0]),
               to = static_cast<std::size_t>(msm::tetrahedron_edges[e][1]);
    const Vector3d pull = tensions[static_cast<Eigen::Index>(e)] * (x[to] - x[from]).normalized();
    pulls[from] += pull;
    pulls[to] -= pull;
  }
  for (std::size_t v = 0; v < 4; ++v) CHECK((forces[v] - pulls[v]).norm() <= 1e-14); // N, of 0.1
}

TEST_CASE("the stiffness of biquadratic springs depends neither on the order of vertices nor on its sign",
          "[verification]") {
  const TetrahedronPositions turned{slanted[1], slanted[0], slanted[2], slanted[3]}; // inside out
  CHECK(msm::tetrahedron_volume(turned) == Approx(-msm::tetrahedron_volume(slanted)).epsilon(1e-14));
  // Edges (0,1), (0,2), (0,3), (1,2), (1,3), (2,3) become (1,0), (1,2), (1,3), (0,2), (0,3), (2,3).
  const std::array<int, 6> now{0, 3, 4, 1, 2, 5};
  const msm::EdgeMatrix other = msm::biquadratic_stiffness(turned, soft_lambda, soft_mu);
  for (int e = 0; e < 6; ++e)
    for (int f = 0; f < 6; ++f)
      CHECK(other(now[static_cast<std::size_t>(e)], now[static_cast<std::size_t>(f)]) ==
            Approx(slanted_stiffness(e, f)).margin(1e-14));
}

TEST_CASE("a rigid motion of a tetrahedron gives no force") {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(1.9, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  TetrahedronPositions x = slanted;
  for (Vector3d& point : x) point = rotation * point + Vector3d(3, -8, 5);
  for (const Vector3d& force : msm::biquadratic_forces(x, slanted_lengths, slanted_stiffness))
    CHECK(force.norm() < 1e-13); // N; rounding of positions of 10 mm times stiffness times length²
}

TEST_CASE("the tangent of a tetrahedron is the derivative of minus its forces") {
  const TetrahedronPositions at = deformed();
  const msm::TetrahedronMatrix tangent =
      msm::biquadratic_tangent(at, slanted_lengths, slanted_stiffness, msm::TransverseTerm::exact);
  const double h = 1e-5; // mm; forces are cubic: the central difference errs by h² times a stiffness
  for (int column = 0; column < 12; ++column) {
    TetrahedronPositions before = at, after = at;
    before[static_cast<std::size_t>(column / 3)][column % 3] -= h;
    after[static_cast<std::size_t>(column / 3)][column % 3] += h;
    const auto low = msm::biquadratic_forces(before, slanted_lengths, slanted_stiffness),
               high = msm::biquadratic_forces(after, slanted_lengths, slanted_stiffness);
    for (int row = 0; row < 12; ++row) {
      const auto v = static_cast<std::size_t>(row / 3);
      CHECK(tangent(row, column) == Approx((low[v][row % 3] - high[v][row % 3]) / (2 * h)).margin(1e-7));
    }
  }
}

TEST_CASE("clamped, the tangent of a compressed tetrahedron has no negative eigenvalue") {
  TetrahedronPositions x = slanted;
  for (Vector3d& point : x) point *= 0.6;
  const auto lowest = [&](msm::TransverseTerm term) {
    return Eigen::SelfAdjointEigenSolver<msm::TetrahedronMatrix>(
               msm::biquadratic_tangent(x, slanted_lengths, slanted_stiffness, term))
        .eigenvalues()
        .minCoeff();
  };
  CHECK(lowest(msm::TransverseTerm::exact) < -1e-3);
  CHECK(lowest(msm::TransverseTerm::clamped) > -1e-14); // rounding of zero
}
