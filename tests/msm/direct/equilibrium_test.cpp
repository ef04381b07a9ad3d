#include "mechanics/equilibrium/find_equilibrium.hpp"

#include "cases/case/error.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/model.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/little_memory.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <new>

using namespace springproof;

using Eigen::Vector3d;
using msm::CellStiffness;
using msm::Problem;

namespace {

Problem make_problem(const cases::Case& definition, const CellStiffness& stiffness) {
  const cases::Scene scene = cases::make_scene(definition);
  return {scene.mesh, msm::make_lattice(scene.mesh, {stiffness}), cases::loaded_nodes(scene),
          cases::constrained_dofs(scene)};
}

/// Right side of eq. 5.3: the side for which the cell's vertices are balanced across the pull.
double side(const CellStiffness& k, double width, double height) {
  const double sin_a = width / std::hypot(width, height),
               sin_b = std::sqrt(2.0) * width / std::hypot(std::sqrt(2.0) * width, height);
  return (k.edge + (1 + std::sqrt(2.0) * sin_a) * k.face_diagonal +
          std::sqrt(6.0) / 2 * sin_b * k.internal_diagonal) /
         (k.edge + 2 * k.face_diagonal + k.internal_diagonal);
}

/// Eq. 5.4: pull on each vertex of the top face.
double pull(const CellStiffness& k, double width, double height) {
  const double cos_a = height / std::hypot(width, height),
               cos_b = height / std::hypot(std::sqrt(2.0) * width, height);
  return height * (k.edge + 2 * k.face_diagonal + k.internal_diagonal) -
         (k.edge + 2 * std::sqrt(2.0) * k.face_diagonal * cos_a +
          std::sqrt(3.0) * k.internal_diagonal * cos_b);
}

} // namespace

TEST_CASE("one cell pulled along z takes the shape of thesis eqs 5.3 and 5.4", "[verification]") {
  const CellStiffness k = bodies::cell(31, 47, 33);
  for (double height : {0.8, 1.05, 1.3, 1.9}) {
    double width = 1;
    for (int n = 0; n < 400; ++n) width = side(k, width, height); // a contraction by less than 1/2
    cases::Case cell = bodies::clamped_box({1, 1, 1}, bodies::tensile(pull(k, width, height)));
    cell.fixed = {{bodies::region("x-"), {true, false, false}},
                  {bodies::region("y-"), {false, true, false}},
                  {bodies::region("z-"), {false, false, true}}};
    const Problem problem = make_problem(cell, k);
    mechanics::EquilibriumSettings settings;
    settings.tolerance = 1e-12;
    const auto system = msm::make_direct_system(problem);
    const msm::Vector rest = msm::Vector::Zero(system->load().size());
    const Eigen::Vector3d corner =
        msm::to_points(problem, mechanics::find_equilibrium(*system, rest, "springs", settings).state).back();
    CHECK(1 + corner.x() == Approx(width).epsilon(1e-10)); // as asked; residual 1e-12
    CHECK(1 + corner.y() == Approx(width).epsilon(1e-10));
    CHECK(1 + corner.z() == Approx(height).epsilon(1e-10));
  }
}

TEST_CASE("a factorisation that memory is too small for says so, and loses no equilibrium",
          "[little_memory]") {
  const auto solve = [](int n) {
    cases::Scene scene = cases::make_scene(bodies::clamped_box({n, n, n}, bodies::tensile(0.001)));
    return msm::Model(scene, {bodies::thesis_cell}, {msm::Path::direct, 1}).solve();
  };
  const cases::Solution before = solve(10); // BLAS has its work space from here on
  {
    const LittleMemory little(200 << 20); // the factor takes twice as much
    CHECK_THROWS_AS(solve(24), std::bad_alloc);
  }
  CHECK(largest_difference(solve(10), before) == 0);
}
