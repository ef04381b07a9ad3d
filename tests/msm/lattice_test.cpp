#include "msm/spring_body.hpp"

#include "mechanics/dense.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/linear_tetrahedron.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace springproof;

using Eigen::Vector3d;
using msm::Lattice;
using msm::Points;

namespace {

/// Assembled stiffness (N/m) of the spring between the nodes at two places of the unit grid; 0 when there is
/// none.
double between(const Lattice& lattice, const Vector3d& a, const Vector3d& b) {
  for (const msm::Link& link : lattice.links) {
    const Vector3d &i = lattice.rest[static_cast<std::size_t>(link.i)],
                   &j = lattice.rest[static_cast<std::size_t>(link.j)];
    if ((i == a && j == b) || (i == b && j == a)) return 1e3 * link.spring.stiffness;
  }
  return 0;
}

/// A lattice of Hooke's springs, or of power-log springs with three exponents.
Lattice any_lattice() {
  msm::CellStiffness springs = bodies::cell(31, 47, 33, 0.14);
  springs.midline = 0.1;
  springs.exponents = GENERATE(as<std::optional<msm::Exponents>>{}, std::nullopt,
                               std::optional(msm::Exponents{-1.3, -2, 4.3}));
  return msm::make_lattice(cases::make_grid_mesh(bodies::masked_grid()), {springs});
}

} // namespace

TEST_CASE("springs shared by cells are one spring with the sum of their stiffnesses") {
  const Lattice lattice =
      msm::make_lattice(cases::make_box_mesh({2, 2, 2}, {2, 2, 2}), {bodies::cell(31, 47, 33, 0.14)});
  const double tolerance = 1e-14; // relative; a sum of at most four equal terms
  const Vector3d centre(1, 1, 1);
  SECTION("inside the body") {
    CHECK(between(lattice, centre, {1, 1, 2}) == Approx(4 * 31).epsilon(tolerance));
    CHECK(between(lattice, centre, {1, 2, 2}) == Approx(2 * 47).epsilon(tolerance));
    CHECK(between(lattice, centre, {2, 2, 2}) == Approx(33).epsilon(tolerance));
  }
  SECTION("on the body's surface") {
    CHECK(between(lattice, {1, 0, 0}, {2, 0, 0}) == Approx(31).epsilon(tolerance));
    CHECK(between(lattice, {1, 1, 0}, {2, 1, 0}) == Approx(2 * 31).epsilon(tolerance));
    CHECK(between(lattice, {1, 1, 0}, {2, 2, 0}) == Approx(47).epsilon(tolerance));
  }
  SECTION("springs of every kind, each once") {
    const std::size_t edges = 3 * 2 * 9, face_diagonals = 2 * 3 * 4 * 3, internal_diagonals = 4 * 8;
    CHECK(lattice.links.size() == edges + face_diagonals + internal_diagonals);
    CHECK(lattice.volume_cells.size() == 8);
  }
}

TEST_CASE("a lattice with cells missing has the springs of the present cells alone") {
  // present: (0,0,0) (1,0,0) (0,1,0) (1,0,1)
  const Lattice lattice = bodies::masked_lattice();
  const double tolerance = 1e-14; // relative; a sum of at most four equal terms
  CHECK(between(lattice, {1, 1, 0}, {1, 1, 1}) == Approx(3 * 31).epsilon(tolerance)); // three cells meet here
  CHECK(between(lattice, {1, 0, 0}, {1, 1, 1}) == Approx(2 * 47).epsilon(tolerance));
  CHECK(between(lattice, {1, 0, 1}, {1, 1, 2}) == Approx(47).epsilon(tolerance));
  CHECK(between(lattice, {1, 1, 0}, {2, 1, 1}) == Approx(47).epsilon(tolerance));
  CHECK(between(lattice, {1, 1, 0}, {2, 2, 1}) == 0); // the cell (1,1,0) is missing
  CHECK(lattice.volume_cells.size() == 4);
}

TEST_CASE("cells of different stiffness add what each brings") {
  const cases::Mesh mesh = cases::make_box_mesh({2, 1, 1}, {2, 1, 1});
  const Lattice lattice = msm::make_lattice(mesh, {bodies::cell(1, 2, 3), bodies::cell(10, 20, 30)});
  const double tolerance = 1e-14; // relative; a sum of two terms
  CHECK(between(lattice, {1, 0, 0}, {1, 1, 0}) == Approx(11).epsilon(tolerance));
  CHECK(between(lattice, {1, 0, 0}, {1, 1, 1}) == Approx(22).epsilon(tolerance));
  CHECK(between(lattice, {0, 0, 0}, {1, 1, 1}) == Approx(3).epsilon(tolerance));
  CHECK(between(lattice, {1, 0, 0}, {2, 1, 1}) == Approx(30).epsilon(tolerance));
}

TEST_CASE("a rigid motion of the lattice gives no force") {
  const Lattice lattice = any_lattice();
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(1.9, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  Points moved = lattice.rest;
  for (Vector3d& point : moved) point = rotation * point + Vector3d(3, -8, 5);
  for (const Vector3d& force : msm::internal_force(lattice, moved))
    CHECK(force.norm() < 1e-14);              // N; rounding of k |x| = 0.1 N/mm 10 mm
  CHECK(msm::energy(lattice, moved) < 1e-28); // N mm, quadratic in that
}

TEST_CASE("springs of different laws between the same points stay apart") {
  msm::CellStiffness hooke = bodies::cell(1, 2, 3), power_log = hooke, other = hooke;
  power_log.exponents = {-1, -1, -1};
  other.exponents = {-1, -1, 2};
  const auto n_links = [](const msm::CellStiffness& left, const msm::CellStiffness& right) {
    return msm::make_lattice(cases::make_box_mesh({2, 1, 1}, {{2, 1, 1}}), {left, right}).links.size();
  };
  const std::size_t shared = 4 + 2; // edges and diagonals of the face between the two cells
  CHECK(n_links(hooke, hooke) == 2 * 28 - shared);
  CHECK(n_links(power_log, other) == 2 * 28 - shared); // internal diagonals are of one cell
  CHECK(n_links(hooke, power_log) == 2 * 28);
}

TEST_CASE("forces by displacements are those by positions, and keep their digits far from the origin") {
  msm::Lattice here = any_lattice(), far = here;
  for (Vector3d& point : far.rest) point += Vector3d(0, 0, 1 << 20);
  Points displacement(here.rest.size(), Vector3d::Zero());
  displacement = bodies::disturbed(displacement, 1e-6);
  Points positions = here.rest;
  for (std::size_t p = 0; p < positions.size(); ++p) positions[p] += displacement[p];
  const Points expected = msm::internal_force_at(here, displacement);
  const auto norm = [](const Vector3d& force) { return force.norm(); };
  CHECK(largest_difference(msm::internal_force(here, positions), expected, norm) < 1e-14); // N, of 1e-8
  CHECK(msm::energy_at(here, displacement) == Approx(msm::energy(here, positions)).epsilon(1e-8));
  CHECK(largest_difference(msm::internal_force_at(far, displacement), expected, norm) == 0);
}

namespace {

msm::CellPositions distorted_cell() {
  const msm::Points points =
      bodies::disturbed(cases::make_box_mesh({1, 1.2, 0.8}, {1, 1, 1}).nodes.to_vector(), 0.2);
  msm::CellPositions x;
  std::copy(points.begin(), points.end(), x.begin());
  return x;
}

msm::CellPositions moved(msm::CellPositions x, int vertex, int axis, double by) {
  x[static_cast<std::size_t>(vertex)][axis] += by;
  return x;
}

constexpr double volume_step =
    1e-4; // mm; V is linear in one coordinate, so that only rounding, 1e-16/h, is left

} // namespace

TEST_CASE("the volume of a distorted cell is what quadrature gives") {
  const msm::CellPositions x = distorted_cell();
  CHECK(msm::volume_of(x) == Approx(cases::cell_volume({x.begin(), x.end()})).epsilon(1e-14)); // rounding
}

TEST_CASE("the gradient of a cell's volume is its derivative") {
  const msm::CellPositions x = distorted_cell();
  const auto gradient = msm::volume_gradient(x);
  for (int v = 0; v < 8; ++v)
    for (int a = 0; a < 3; ++a) {
      const double difference =
          (msm::volume_of(moved(x, v, a, volume_step)) - msm::volume_of(moved(x, v, a, -volume_step))) /
          (2 * volume_step);
      CHECK(gradient[static_cast<std::size_t>(v)][a] == Approx(difference).margin(1e-11)); // see volume_step
    }
}

TEST_CASE("the second derivative of a cell's volume is its gradient's derivative") {
  const msm::CellPositions x = distorted_cell();
  const auto second = msm::volume_second_derivative(x);
  for (int b = 0; b < 8; ++b)
    for (int j = 0; j < 3; ++j) {
      const auto after = msm::volume_gradient(moved(x, b, j, volume_step)),
                 before = msm::volume_gradient(moved(x, b, j, -volume_step));
      for (std::size_t a = 0; a < 8; ++a) {
        const Vector3d difference = (after[a] - before[a]) / (2 * volume_step);
        CHECK((second[a][static_cast<std::size_t>(b)].col(j) - difference).norm() < 1e-11); // see volume_step
      }
    }
}

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

const msm::Tetrahedron springs = msm::make_tetrahedron({0, 1, 2, 3}, slanted, soft_lambda, soft_mu);

} // namespace

TEST_CASE("the derivatives of a tetrahedron's volume are what differences give", "[verification]") {
  const auto at = [](int v, int a, double by) {
    TetrahedronPositions x = slanted;
    x[static_cast<std::size_t>(v)][a] += by;
    return x;
  };
  const auto gradient = msm::volume_gradient(slanted);
  const auto second = msm::volume_second_derivative(slanted);
  for (int b = 0; b < 4; ++b)
    for (int j = 0; j < 3; ++j) {
      const auto after = at(b, j, volume_step), before = at(b, j, -volume_step);
      CHECK(gradient[static_cast<std::size_t>(b)][j] ==
            Approx((msm::volume_of(after) - msm::volume_of(before)) / (2 * volume_step)).margin(1e-11));
      for (std::size_t a = 0; a < 4; ++a) {
        const Vector3d difference =
            (msm::volume_gradient(after)[a] - msm::volume_gradient(before)[a]) / (2 * volume_step);
        CHECK((second[a][static_cast<std::size_t>(b)].col(j) - difference).norm() < 1e-11); // see volume_step
      }
    }
}

TEST_CASE("biquadratic springs store what a linear St. Venant-Kirchhoff tetrahedron stores",
          "[verification]") {
  const TetrahedronPositions x = deformed();
  // The same number by strains and by lengths: round-off.
  CHECK(springs.energy(x) ==
        Approx(linear_tetrahedron::energy(slanted, x, soft_lambda, soft_mu)).epsilon(1e-13));
  const auto forces = springs.forces(x),
             expected = linear_tetrahedron::forces(slanted, x, soft_lambda, soft_mu);
  for (std::size_t v = 0; v < 4; ++v) CHECK((forces[v] - expected[v]).norm() <= 1e-14); // N, of 0.1
}

TEST_CASE("the tensions of a tetrahedron's edges add up to its forces", "[verification]") {
  const TetrahedronPositions x = deformed();
  const auto forces = springs.forces(x);
  const msm::EdgeValues tensions = springs.tensions(x);
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
  CHECK(msm::volume_of(turned) == Approx(-msm::volume_of(slanted)).epsilon(1e-14));
  // Edges (0,1), (0,2), (0,3), (1,2), (1,3), (2,3) become (1,0), (1,2), (1,3), (0,2), (0,3), (2,3).
  const std::array<int, 6> now{0, 3, 4, 1, 2, 5};
  const msm::EdgeMatrix other = msm::biquadratic_stiffness(turned, soft_lambda, soft_mu);
  for (int e = 0; e < 6; ++e)
    for (int f = 0; f < 6; ++f)
      CHECK(other(now[static_cast<std::size_t>(e)], now[static_cast<std::size_t>(f)]) ==
            Approx(springs.stiffness(e, f)).margin(1e-14));
}

TEST_CASE("a rigid motion of a tetrahedron gives no force") {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(1.9, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  TetrahedronPositions x = slanted;
  for (Vector3d& point : x) point = rotation * point + Vector3d(3, -8, 5);
  for (const Vector3d& force : springs.forces(x))
    CHECK(force.norm() < 1e-13); // N; rounding of positions of 10 mm times stiffness times length²
}

TEST_CASE("the tangent of a tetrahedron is the derivative of minus its forces") {
  const TetrahedronPositions at = deformed();
  const msm::TetrahedronMatrix tangent = springs.tangent_matrix(at, msm::Clamp::no);
  const double h = 1e-5; // mm; forces are cubic: the central difference errs by h² times a stiffness
  for (int column = 0; column < 12; ++column) {
    TetrahedronPositions before = at, after = at;
    before[static_cast<std::size_t>(column / 3)][column % 3] -= h;
    after[static_cast<std::size_t>(column / 3)][column % 3] += h;
    const auto low = springs.forces(before), high = springs.forces(after);
    for (int row = 0; row < 12; ++row) {
      const auto v = static_cast<std::size_t>(row / 3);
      CHECK(tangent(row, column) == Approx((low[v][row % 3] - high[v][row % 3]) / (2 * h)).margin(1e-7));
    }
  }
}

TEST_CASE("clamped, the tangent of a compressed tetrahedron has no negative eigenvalue") {
  TetrahedronPositions x = slanted;
  for (Vector3d& point : x) point *= 0.6;
  const auto lowest = [&](msm::Clamp clamp) {
    return mechanics::eigenvalues(springs.tangent_matrix(x, clamp))[0];
  };
  CHECK(lowest(msm::Clamp::no) < -1e-3);
  CHECK(lowest(msm::Clamp::yes) > -1e-14); // rounding of zero
}
