#include "cases/scene/scene.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using Eigen::Vector3d;

namespace {

cases::Region part(const Vector3d& lower, const Vector3d& upper) {
  cases::Region region;
  region.name = "part";
  region.part = cases::Part{"", lower, upper};
  return region;
}

cases::Case block(const std::array<int, 3>& cells) {
  cases::Case definition = bodies::clamped_box(cells, {});
  definition.fixed.clear();
  return definition;
}

cases::Moved moved(const cases::Region& region, const Vector3d& displacement) {
  cases::Moved motion;
  motion.region = region;
  motion.displacement = displacement;
  return motion;
}

cases::ScaledDisplacement along_x(double length) {
  return {{0, 0, 0}, {1, 0, 0}, length, {}};
}

/// Solutions of both models, the finite elements first.
std::vector<cases::Solution> solve_both(const cases::Scene& scene) {
  std::optional<msm::DesignResult> design;
  const compare::Answer springs = compare::solve_springs(scene, 1, design);
  const compare::Answer fem = compare::solve_fem_as_given(scene);
  for (const compare::Answer* answer : {&fem, &springs}) {
    INFO(answer->solution.message);
    REQUIRE(answer->converged());
  }
  return {fem.solution, springs.solution};
}

} // namespace

TEST_CASE("a block whose faces move by one scaled displacement is deformed evenly in both models") {
  for (const int fineness : {1, 2}) { // factorised, and on the grid
    const double x = 6 * fineness, y = 4 * fineness, z = 4 * fineness;
    cases::Case definition = block({6 * fineness, 4 * fineness, 4 * fineness});
    const Vector3d way = fineness * Vector3d(-0.6, 0.3, 0.1);
    for (const cases::Region& face : {bodies::region("z-"), bodies::region("z+"),
                                      part({1, 0, 1}, {x, 0, z - 1}), part({1, y, 1}, {x, y, z - 1})}) {
      definition.moved.push_back(moved(face, way));
      definition.moved.back().scaled = along_x(x);
    }
    definition.moved.push_back(moved(part({x, 1, 1}, {x, y - 1, z - 1}), way));
    definition.fixed = {{part({0, 0, 1}, {0, y, z - 1})}};
    const cases::Scene scene = cases::make_scene(definition);
    for (const cases::Solution& solution : solve_both(scene)) {
      double largest = 0;
      for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
        const Vector3d rest = scene.mesh.nodes[n];
        largest = larger(largest, (solution.displacement[n] - rest.x() / x * way).norm());
      }
      CHECK(largest <= 1e-7); // mm: 1e-9 of the supports' forces over the lattice's lowest stiffness
    }
  }
}

TEST_CASE("load steps that a motion asks for are taken by both models") {
  cases::Case definition = block({3, 3, 3});
  definition.fixed = {{bodies::region("z-")}};
  definition.moved = {moved(bodies::region("z+"), {0, 0, -0.1})};
  const auto once = solve_both(cases::make_scene(definition));
  definition.moved[0].steps = 7;
  const auto in_steps = solve_both(cases::make_scene(definition));
  for (std::size_t side = 0; side < 2; ++side) {
    CHECK(in_steps[side].newton_iterations >= 7);
    CHECK(in_steps[side].newton_iterations > once[side].newton_iterations);
    CHECK(largest_difference(once[side], in_steps[side]) < 1e-7); // mm; as above
  }
}

TEST_CASE("the sides of a joined cut come together, node by node, where they mirror each other") {
  cases::Case definition = block({15, 2, 6});
  definition.fixed = {{part({0, 0, 0}, {7, 2, 0})}};
  definition.moved = {moved(part({8, 0, 0}, {15, 2, 0}), {-1, 0, 0})};
  definition.removed = {{{7, 0, 0}, {8, 2, 3}, cases::Axis::x, {}}};
  const cases::Scene scene = cases::make_scene(definition);
  for (const cases::Solution& solution : solve_both(scene)) {
    int n_pairs = 0;
    for (const int a : scene.moved[1].selection.nodes)
      for (const int b : scene.moved[2].selection.nodes) {
        const Vector3d lower = scene.mesh.nodes[cases::index(a)], upper = scene.mesh.nodes[cases::index(b)];
        if (upper - lower != Vector3d(1, 0, 0)) continue;
        ++n_pairs;
        const Vector3d apart =
            upper + solution.displacement[cases::index(b)] - lower - solution.displacement[cases::index(a)];
        CHECK(apart.norm() <= 1e-6); // mm; as above, and both sides are solved for
      }
    CHECK(n_pairs == 2 * 3);
  }
}

TEST_CASE("force scaling by numbers of iterations says how far from equilibrium it ends") {
  cases::Case definition = block({4, 3, 3});
  definition.fixed = {{bodies::region("z-")}};
  definition.moved = {moved(bodies::region("z+"), {0.2, 0, -0.1})};
  std::optional<msm::DesignResult> design;
  const auto solve = [&] {
    return compare::solve_springs(cases::make_scene(definition), 1, design).solution;
  };
  const cases::Solution newton = solve();
  definition.msm.solver = cases::Solver::force_scaling;
  definition.msm.relaxation = cases::RelaxationCounts{2, 3, 10};
  const cases::Solution few = solve();
  REQUIRE(few.from_equilibrium);
  REQUIRE(few.from_equilibrium->largest);
  CHECK_FALSE(few.is_equilibrium());
  CHECK(*few.from_equilibrium->largest ==
        Approx(largest_difference(few, newton)).epsilon(1e-6)); // tolerance of two solves
  CHECK(*few.from_equilibrium->root_mean_square < *few.from_equilibrium->largest);
  CHECK(*few.from_equilibrium->root_mean_square > 0);
}
