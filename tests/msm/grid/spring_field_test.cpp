#include "msm/grid/spring_field.hpp"

#include "msm/direct/direct_system.hpp"
#include "msm/grid/grid_system.hpp"
#include "msm/tangent.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using msm::CellStiffness;
using msm::Clamp;
using msm::Points;
using msm::Problem;
using msm::Vector;
using msm::grid::Field;

namespace {

struct Both {
  Problem problem;
  msm::grid::GridProblem grid;
  Points displacement, direction;
  Both(const cases::Mesh& mesh, const std::vector<CellStiffness>& stiffness)
      : problem{
            mesh, msm::make_lattice(mesh, stiffness), {}, std::vector<bool>(3 * mesh.nodes.size(), false)} {
    for (std::size_t d : {0, 1, 2, 5, 10}) problem.is_constrained[d] = true;
    grid = msm::grid::make_grid_problem(problem, stiffness);
    const Points zero(mesh.nodes.size(), Eigen::Vector3d::Zero());
    displacement = held(bodies::disturbed(zero, 0.3 * mesh.grid->spacing.minCoeff()));
    direction = held(bodies::disturbed(bodies::disturbed(zero, 0.7), 0.4));
  }
  Points held(Points points) const {
    for (std::size_t d = 0; d < problem.is_constrained.size(); ++d)
      if (problem.is_constrained[d]) points[d / 3][static_cast<int>(d % 3)] = 0;
    return points;
  }
  Points positions() const {
    Points x = displacement;
    for (std::size_t n = 0; n < x.size(); ++n) x[n] += problem.lattice.rest[n];
    return x;
  }
  template<class Real>
  Field<Real> field(const Points& points) const {
    return msm::grid::to_field(problem, grid.body, points).cast<Real>();
  }
  template<class Real>
  Vector free(const Field<Real>& field) const {
    return msm::to_vector(problem, msm::grid::to_points(problem, grid.body, field.template cast<double>()));
  }
};

std::vector<Both> bodies_of_all_kinds() {
  std::vector<Both> all;
  const CellStiffness springs = bodies::cell(31, 47, 33), hybrid = bodies::cell(31, 47, 33, 0.14);
  all.emplace_back(cases::make_box_mesh({5, 4, 11}, {5, 4, 11}), std::vector{springs});
  all.emplace_back(cases::make_box_mesh({17, 2, 2}, {17, 2, 2}), std::vector{hybrid});
  all.emplace_back(cases::make_box_mesh({60, 2, 2}, {60, 2, 2}),
                   std::vector{hybrid}); // several tiles in a row
  all.emplace_back(cases::make_box_mesh({3, 2, 0.6}, {3, 2, 2}), std::vector{hybrid}); // flat cells
  all.emplace_back(cases::make_grid_mesh(bodies::masked_grid()), std::vector{hybrid});
  all.emplace_back(cases::make_box_mesh({2, 1, 1}, {2, 1, 1}),
                   std::vector{springs, bodies::cell(310, 4, 90, 0.05)}); // two materials
  // power-log springs, of one exponent each and with one where the energy's closed form has no value
  CellStiffness stiffening = springs, softening = hybrid, other = bodies::cell(310, 4, 90, 0.05);
  stiffening.exponents = {4.3, 1.8, 0.5};
  softening.exponents = other.exponents = {-1.3, -1, -2.6};
  all.emplace_back(cases::make_box_mesh({5, 4, 11}, {{5, 4, 11}}), std::vector{stiffening});
  all.emplace_back(cases::make_box_mesh({60, 2, 2}, {{60, 2, 2}}), std::vector{softening});
  all.emplace_back(cases::make_box_mesh({3, 2, 0.6}, {{3, 2, 2}}), std::vector{softening});
  all.emplace_back(cases::make_grid_mesh(bodies::masked_grid()), std::vector{softening});
  all.emplace_back(cases::make_box_mesh({2, 1, 1}, {{2, 1, 1}}), std::vector{softening, other});
  CellStiffness with_midlines = hybrid, softening_midlines = softening;
  with_midlines.midline = 0.2;
  softening_midlines.midline = 0.15;
  all.emplace_back(cases::make_box_mesh({5, 4, 11}, {{5, 4, 11}}), std::vector{with_midlines});
  all.emplace_back(cases::make_box_mesh({60, 2, 2}, {{60, 2, 2}}), std::vector{softening_midlines});
  all.emplace_back(cases::make_box_mesh({3, 2, 0.6}, {{3, 2, 2}}), std::vector{softening_midlines});
  all.emplace_back(cases::make_grid_mesh(bodies::masked_grid()), std::vector{softening_midlines});
  with_midlines.volume = 0; // midlines need no volume terms
  all.emplace_back(cases::make_box_mesh({2, 1, 1}, {{2, 1, 1}}), std::vector{with_midlines, springs});
  return all;
}

} // namespace

TEST_CASE("force and energy of a grid are those of its lattice") {
  for (const Both& both : bodies_of_all_kinds()) {
    const msm::grid::SpringField<double> springs(both.grid.body, 1);
    Field<double> force = both.field<double>(both.displacement);
    springs.force(both.field<double>(both.displacement), force);
    const Vector reference =
        msm::to_vector(both.problem, msm::internal_force(both.problem.lattice, both.positions()));
    CHECK(largest_entry(both.free(force) - reference) < 1e-13 * largest_entry(reference)); // rounding
    CHECK(springs.energy(both.field<double>(both.displacement)) ==
          Approx(msm::energy(both.problem.lattice, both.positions())).epsilon(1e-13)); // rounding
  }
}

TEST_CASE("the tangent of a grid, exact and clamped, is that of its lattice") {
  for (const Both& both : bodies_of_all_kinds())
    for (Clamp clamp : {Clamp::no, Clamp::yes}) {
      msm::Tangent tangent(both.problem.lattice, both.problem.is_constrained);
      const Vector reference = tangent.assemble(both.positions(), clamp).selfadjointView<Eigen::Lower>() *
                               msm::to_vector(both.problem, both.direction);
      const auto check = [&](auto real, double tolerance) {
        using Real = decltype(real);
        const msm::grid::SpringField<Real> springs(both.grid.body, 1);
        Field<Real> product = both.field<Real>(both.direction);
        springs.product(clamp, both.field<Real>(both.displacement), both.field<Real>(both.direction),
                        product);
        CHECK(largest_entry(both.free(product) - reference) < tolerance * largest_entry(reference));
      };
      check(double{}, 1e-13); // rounding
      check(float{}, 1e-5);   // rounding in single precision, some tens of terms
    }
}

TEST_CASE("products of a kept tangent are those of the tangent") {
  for (const Both& both : bodies_of_all_kinds()) {
    const auto check = [&](auto real, double tolerance) {
      using Real = decltype(real);
      msm::grid::SpringField<Real> springs(both.grid.body, 1);
      const bool has_exponents = both.grid.body.exponents.has_value();
      REQUIRE(springs.keep_tangent() == has_exponents);
      if (!has_exponents) return;
      const Field<Real> at = both.field<Real>(both.displacement),
                        direction = both.field<Real>(both.direction);
      Field<Real> inverse, reference = direction, product = direction;
      springs.inverse_diagonal(Clamp::yes, at, inverse);
      springs.kept_product(at, direction, product);
      springs.product(Clamp::yes, at, direction, reference);
      CHECK(largest_entry(both.free(product) - both.free(reference)) <
            tolerance * largest_entry(both.free(reference)));
    };
    check(double{}, 1e-13); // rounding
    check(float{}, 1e-5);   // rounding in single precision, some tens of terms
  }
}

TEST_CASE("the inverse diagonal of a grid inverts the tangent's diagonal blocks") {
  for (const Both& both : bodies_of_all_kinds()) {
    msm::Tangent tangent(both.problem.lattice, std::vector<bool>(both.problem.is_constrained.size(), false));
    const msm::Tangent::Matrix& matrix = tangent.assemble(both.positions(), Clamp::yes);
    Field<double> inverse;
    msm::grid::SpringField<double>(both.grid.body, 1)
        .inverse_diagonal(Clamp::yes, both.field<double>(both.displacement), inverse);
    const cases::Grid& cells = *both.problem.mesh.grid;
    const auto size = both.grid.body.layout.size;
    const int order[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    int n_free = 0;
    for (std::size_t node = 0; node < both.problem.mesh.nodes.size(); ++node) {
      const auto is_held = [&](std::size_t c) { return both.problem.is_constrained[3 * node + c]; };
      if (is_held(0) || is_held(1) || is_held(2)) continue;
      ++n_free;
      const Eigen::Vector3d place = both.problem.mesh.nodes[node].cwiseQuotient(cells.spacing);
      const auto at = both.grid.body.layout.at(int(std::lround(place.x())), int(std::lround(place.y())),
                                               int(std::lround(place.z())));
      Eigen::Matrix3d block, inverted;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
          block(r, c) = matrix.coeff(int(3 * node) + std::max(r, c), int(3 * node) + std::min(r, c));
          inverted(r, c) = inverse[order[r][c] * size + at];
        }
      CHECK((block * inverted - Eigen::Matrix3d::Identity()).norm() <
            1e-9); // rounding times the block's condition
    }
    CHECK(n_free > 0);
  }
}

TEST_CASE("results of the kernels do not depend on the number of threads") {
  const Both both(cases::make_box_mesh({15, 15, 60}, {15, 15, 60}) /* large enough for threads */,
                  {bodies::cell(31, 47, 33, 0.14)});
  const Field<double> u = both.field<double>(both.displacement);
  Field<double> one = u, two = u;
  msm::grid::SpringField<double>(both.grid.body, 1).force(u, one);
  msm::grid::SpringField<double>(both.grid.body, 2).force(u, two);
  CHECK(one == two);
  CHECK(msm::grid::SpringField<double>(both.grid.body, 1).energy(u) ==
        msm::grid::SpringField<double>(both.grid.body, 2).energy(u));
}
