#include "msm/spring_body.hpp"

#include "tests/support/bodies.hpp"

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
  return bodies::masked_lattice(GENERATE(as<std::optional<msm::Exponents>>{}, std::nullopt,
                                         std::optional(msm::Exponents{-1.3, -2, 4.3})));
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
  const cases::HexMesh mesh = cases::make_box_mesh({2, 1, 1}, {2, 1, 1});
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

TEST_CASE("the internal force of a lattice is minus the gradient of its energy") {
  const Lattice lattice = any_lattice();
  const Points at = bodies::disturbed(lattice.rest, 0.2);
  const Points force = msm::internal_force(lattice, at);
  const double h = 1e-6; // mm; the central difference then errs by about 1e-13, its rounding by 1e-10
  for (std::size_t p = 0; p < at.size(); ++p)
    for (int a = 0; a < 3; ++a) {
      Points before = at, after = at;
      before[p][a] -= h;
      after[p][a] += h;
      const double difference = (msm::energy(lattice, after) - msm::energy(lattice, before)) / (2 * h);
      CHECK(force[p][a] == Approx(-difference).margin(1e-9)); // N, see h
    }
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
  msm::Lattice here = bodies::masked_lattice(), far = here;
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
