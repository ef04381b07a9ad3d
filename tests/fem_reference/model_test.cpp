#include "fem_reference/model.hpp"

#include "scenes.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/little_memory.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <new>

using namespace springproof;

using scenes::LoadSet;
using scenes::Test;

namespace {

struct CheckValue {
  Test test;
  LoadSet set;
  std::array<double, 2> measures;
};

void agrees(const cases::Case& definition, const CheckValue& expected, double digit) {
  const cases::Scene scene = cases::make_scene(definition);
  const cases::Solution solution = fem_reference::Model(scene, MPI_COMM_WORLD).solve();
  const auto computed = scenes::cube_measures(expected.test, scene.mesh, solution.displacement);
  CAPTURE(computed[0], computed[1], expected.measures[0], expected.measures[1]);
  for (std::size_t i = 0; i < 2; ++i) CHECK(std::abs(computed[i] - expected.measures[i]) <= digit);
  CHECK(solution.residual <= 1e-9); // asked of every model
  CHECK(solution.load_reached == 1);
  CHECK(solution.inverted_cells == 0);
}

} // namespace

TEST_CASE("the cube in small strain has the heights, tilts and twists that two other solvers gave",
          "[verification]") {
  const CheckValue expected = GENERATE(CheckValue{Test::tensile, LoadSet::small, {10.3466, 10.5906}},
                                       CheckValue{Test::tensile, LoadSet::large, {11.7332, 12.9529}},
                                       CheckValue{Test::shear, LoadSet::small, {3.3480, 3.5229}},
                                       CheckValue{Test::shear, LoadSet::large, {14.8965, 18.9753}},
                                       CheckValue{Test::torsion, LoadSet::small, {4.2538, 6.1765}},
                                       CheckValue{Test::torsion, LoadSet::large, {20.4000, 28.4176}});
  const auto definition = scenes::cube(expected.test, expected.set, scenes::thesis_elastic(),
                                       cases::Formulation::small_strain, cases::Element::q1);
  agrees(definition, expected, 1e-4); // one unit of the last digit given
}

TEST_CASE("the cube of a Saint Venant-Kirchhoff solid has the heights, tilts and twists that two other "
          "solvers gave",
          "[verification]") {
  const CheckValue expected = GENERATE(CheckValue{Test::tensile, LoadSet::small, {10.3291, 10.5308}},
                                       CheckValue{Test::tensile, LoadSet::large, {11.3987, 12.0363}},
                                       CheckValue{Test::shear, LoadSet::small, {3.4075, 3.4674}},
                                       CheckValue{Test::shear, LoadSet::large, {16.4440, 18.0467}},
                                       CheckValue{Test::torsion, LoadSet::small, {4.2465, 6.1293}},
                                       CheckValue{Test::torsion, LoadSet::large, {19.8601, 25.6504}});
  const auto definition = scenes::cube(expected.test, expected.set, scenes::thesis_elastic(),
                                       cases::Formulation::saint_venant_kirchhoff, cases::Element::q1);
  agrees(definition, expected, 1e-4); // one unit of the last digit given
}

TEST_CASE("a factorisation that memory is too small for says so, and loses no equilibrium",
          "[little_memory]") {
  const auto solve = [](int n) {
    auto definition = scenes::cube(scenes::Test::shear, scenes::LoadSet::small, scenes::thesis_elastic(0.35),
                                   cases::Formulation::log_strain, cases::Element::q2_p1, n);
    return fem_reference::Model(cases::make_scene(definition), MPI_COMM_SELF).solve();
  };
  const cases::Solution before = solve(4); // BLAS has its work space from here on
  {
    const LittleMemory little(100 << 20); // the factor takes twice as much
    CHECK_THROWS_AS(solve(8), std::bad_alloc);
  }
  CHECK(largest_difference(solve(4), before) < 1e-9); // mm; the residual of either
}

TEST_CASE("finite elements without unknowns are where their supports are") {
  for (const cases::Element element : {cases::Element::q1, cases::Element::q1_bbar})
    for (const auto backend : {fem_reference::Backend::assembled, fem_reference::Backend::grid}) {
      cases::Case definition;
      definition.body = cases::Box{{1, 1, 1}, {1, 1, 1}};
      definition.material = scenes::thesis_elastic();
      definition.fem.element = element;
      definition.fixed.resize(1);
      definition.fixed[0].region.name = "z-";
      definition.moved.resize(1);
      definition.moved[0].region.name = "z+";
      definition.moved[0].displacement = {0, 0, 0.1};
      const cases::Scene scene = cases::make_scene(definition);
      const cases::Solution found = fem_reference::Model(scene, MPI_COMM_SELF, backend).solve();
      CHECK(found.unknowns == 0);
      for (std::size_t n = 0; n < 8; ++n)
        CHECK(found.displacement[n].z() == Approx(scene.mesh.nodes[n].z() > 0.5 ? 0.1 : 0).margin(1e-12));
    }
}
