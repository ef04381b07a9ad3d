#include "msm/tangent.hpp"

#include "mechanics/dense.hpp"
#include "msm/design/small_strain.hpp"
#include "tests/support/bodies.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

using namespace springproof;

using Eigen::MatrixXd;
using Eigen::VectorXd;
using msm::Clamp;
using msm::Lattice;
using msm::Points;
using msm::Tangent;

namespace {

MatrixXd full(const Tangent::Matrix& lower) {
  return MatrixXd(MatrixXd(lower).selfadjointView<Eigen::Lower>());
}

VectorXd flat(const Points& points) {
  return Eigen::Map<const VectorXd>(points.front().data(), static_cast<Eigen::Index>(3 * points.size()));
}

/// Springs of a law, tetrahedra and a volume term.
Lattice lattice_of_all_terms() {
  cases::Grid grid = bodies::masked_grid();
  std::vector<msm::CellTerms> kinds =
      msm::van_gelder(cases::cell_vertices(cases::make_grid_mesh(grid), 0), 0.3);
  const auto tetrahedra = msm::biquadratic(0.3, 0.1);
  for (std::size_t kind = 0; kind < 2; ++kind) {
    kinds[kind].tetrahedra = tetrahedra[kind].tetrahedra;
    kinds[kind].volume = 0.14;
    kinds[kind].midlines = {{0, 0.1}, {1, 0.2}, {2, 0.3}};
    msm::set_exponents(kinds[kind], {-1.3, -2, 4.3});
  }
  return msm::make_lattice(cases::make_grid_mesh(grid), msm::BodyTerms{kinds, {0, 1, 1, 0}});
}

} // namespace

TEST_CASE(
    "the force of a lattice is minus the gradient of its energy, the tangent minus the force's derivative") {
  const Lattice lattice =
      GENERATE(bodies::masked_lattice(), bodies::masked_lattice(msm::Exponents{-1.3, -2, 4.3}),
               lattice_of_all_terms());
  const Points at = bodies::disturbed(lattice.rest, 0.1);
  const VectorXd force = flat(msm::internal_force(lattice, at));
  Tangent tangent(lattice, std::vector<bool>(3 * at.size(), false));
  const MatrixXd matrix = full(tangent.assemble(at, Clamp::no));
  const double h = 1e-6; // mm; central differences err by about 1e-12, their rounding by 1e-10
  for (std::size_t p = 0; p < at.size(); ++p)
    for (int a = 0; a < 3; ++a) {
      Points before = at, after = at;
      before[p][a] -= h;
      after[p][a] += h;
      const auto column = static_cast<Eigen::Index>(3 * p) + a;
      CHECK(force[column] ==
            Approx((msm::energy(lattice, before) - msm::energy(lattice, after)) / (2 * h)).margin(1e-9)); // N
      const VectorXd difference =
          (flat(msm::internal_force(lattice, after)) - flat(msm::internal_force(lattice, before))) / (2 * h);
      CHECK((matrix.col(column) + difference).norm() < 1e-8); // N/mm
    }
}

TEST_CASE("held degrees of freedom have no row and no column in the tangent") {
  const Lattice lattice = bodies::masked_lattice();
  std::vector<bool> is_constrained(3 * lattice.rest.size(), false);
  is_constrained[0] = is_constrained[4] = is_constrained[17] = true;
  Tangent all(lattice, std::vector<bool>(is_constrained.size(), false)), held(lattice, is_constrained);
  const Points at = bodies::disturbed(lattice.rest, 0.1);
  const MatrixXd whole = full(all.assemble(at, Clamp::no)), part = full(held.assemble(at, Clamp::no));
  REQUIRE(held.n_free() == all.n_free() - 3);
  for (std::size_t i = 0; i < is_constrained.size(); ++i)
    for (std::size_t j = 0; j < is_constrained.size(); ++j) {
      const int row = held.free_number()[i], column = held.free_number()[j];
      CHECK((row < 0) == is_constrained[i]);
      if (row >= 0 && column >= 0)
        CHECK(part(row, column) == whole(static_cast<int>(i), static_cast<int>(j))); // the same sum
    }
}

TEST_CASE("the exact tangent of a compressed lattice may be indefinite, the clamped one never is") {
  const Lattice lattice = bodies::masked_lattice();
  Points at = lattice.rest;
  for (Eigen::Vector3d& point : at) point *= 0.6;
  Tangent tangent(lattice, std::vector<bool>(3 * at.size(), false));
  const auto lowest = [&](Clamp clamp) {
    return mechanics::eigenvalues(full(tangent.assemble(at, clamp)))[0];
  };
  CHECK(lowest(Clamp::no) < -0.01);   // N/mm, of the size of the springs' 0.03
  CHECK(lowest(Clamp::yes) > -1e-14); // N/mm; rounding
}

TEST_CASE("an unloaded lattice has the six rigid motions as its only motions without stiffness") {
  const Lattice lattice = bodies::masked_lattice();
  Tangent tangent(lattice, std::vector<bool>(3 * lattice.rest.size(), false));
  const VectorXd eigenvalues = mechanics::eigenvalues(full(tangent.assemble(lattice.rest, Clamp::no)));
  CHECK(largest_entry(eigenvalues.head(6)) < 1e-14); // N/mm; rounding
  CHECK(eigenvalues[6] > 1e-3);                      // N/mm, against springs of 0.03
}

TEST_CASE("what a small motion of a lattice of any terms stores is half its quadratic form at rest") {
  const msm::Lattice lattice = lattice_of_all_terms();
  const double size = 1e-4; // mm; the energy's third order is 1e-4 of its second
  const msm::Points motion =
      bodies::disturbed(msm::Points(lattice.rest.size(), Eigen::Vector3d::Zero()), size);
  CHECK(msm::small_motion_energy(lattice, motion) ==
        Approx(msm::energy_at(lattice, motion)).epsilon(20 * size));
}
