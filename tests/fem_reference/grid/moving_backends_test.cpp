// The two backends of the finite elements in time: the same equations, so the same trajectories.

#include "cases/scene/scene.hpp"
#include "fem_reference/model.hpp"

#include "tests/fem_reference/grid/moving_block.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::Element;
using Eigen::Vector3d;
using fem_reference::Backend;
using scenes::block;
using scenes::region;

namespace motion_of_two_backends {

namespace {

/// Tolerance: residuals are below 1e-10 of the forces in both; ten steps pass them on.
void agree(const cases::Case& definition) {
  const cases::Scene scene = cases::make_scene(definition);
  const auto steps = fem_reference::default_steps();
  const cases::Solution assembled = fem_reference::follow(scene, steps, Backend::assembled),
                        grid = fem_reference::follow(scene, steps, Backend::grid);
  const auto &a = *assembled.trajectory, &b = *grid.trajectory;
  REQUIRE(b.time == a.time);
  REQUIRE(b.displacement.size() == a.displacement.size());
  double largest = 0, difference = 0, of_volume = 0;
  for (std::size_t n = 0; n < a.displacement.size(); ++n) {
    largest = larger(largest, a.displacement[n].norm());
    difference = larger(difference, (a.displacement[n] - b.displacement[n]).norm());
  }
  difference = larger(difference, largest_difference(assembled, grid));
  for (std::size_t n = 0; n < a.volume.size(); ++n)
    of_volume = larger(of_volume, std::abs(a.volume[n] - b.volume[n]) / a.volume[n]);
  CAPTURE(largest, difference, of_volume, assembled.newton_iterations, grid.newton_iterations,
          grid.linear_iterations);
  CHECK(largest > 0.1);
  CHECK(difference <= 1e-7 * largest);
  CHECK(of_volume <= 1e-7);
  CHECK(grid.factorisations == 0);
  CHECK(grid.unknowns == assembled.unknowns);
}

} // namespace

TEST_CASE("both backends move alike, whatever the law, the element, the mass, the damping and the scheme",
          "[verification]") {
  int n = 0;
  for (const auto formulation : {cases::Formulation::small_strain, cases::Formulation::saint_venant_kirchhoff,
                                 cases::Formulation::log_strain, cases::Formulation::hyperelastic})
    for (const auto element : {Element::q1, Element::q1_bbar, Element::q1_p0, Element::q1_wilson}) {
      if (formulation == cases::Formulation::saint_venant_kirchhoff &&
          (element == Element::q1_bbar || element == Element::q1_p0))
        continue;
      cases::Case definition = block(formulation, element);
      const auto scheme = static_cast<cases::Scheme>(n % 4);
      definition.dynamics->scheme.scheme = scheme;
      definition.fem.mass = n % 3 == 1 ? cases::ElementMass::lumped : cases::ElementMass::consistent;
      if (n % 2 == 1) definition.material_dynamics = {1000., 5, 0.002};
      ++n;
      CAPTURE(cases::name_of(formulation), cases::name_of(element), cases::name_of(scheme));
      agree(definition);
    }
}

TEST_CASE("both backends move alike with several materials, weights, histories and starts in equilibrium",
          "[verification][long]") {
  for (const auto element : {Element::q1, Element::q1_bbar, Element::q1_wilson}) {
    CAPTURE(cases::name_of(element));
    cases::Case definition = block(cases::Formulation::log_strain, element);
    definition.material_dynamics = {1000., 2, 0.001};
    cases::RegionMaterial stiff;
    stiff.material = cases::LinearElastic{0.05, 0.2};
    stiff.dynamics = {2500., 0, 0};
    stiff.lower = Vector3d(3, -INFINITY, 5);
    stiff.upper = Vector3d(7, INFINITY, INFINITY);
    definition.region_materials = {stiff};
    definition.masses.push_back({region("z+"), 1e-4}); // kg; the block has 6e-4
    cases::Load push = scenes::traction("x-", {2e-5, 0, 0});
    push.history.frequency = 15;
    definition.loads.push_back(push);
    agree(definition);
    definition.dynamics->start = cases::MotionStart::equilibrium;
    definition.fem.refine = 1;
    definition.dynamics->end = 0.012;
    agree(definition);
  }
}

TEST_CASE("both backends move alike where supports move", "[verification]") {
  for (const auto element : {Element::q1, Element::q1_bbar, Element::q1_wilson}) {
    CAPTURE(cases::name_of(element));
    cases::Case definition = block(cases::Formulation::log_strain, element);
    definition.material_dynamics = {1000., 2, 0.001};
    definition.fixed.clear();
    cases::Moved moved;
    moved.region = region("z-");
    moved.displacement = Vector3d(2, 0.5, 0);
    moved.history.frequency = 10;
    definition.moved = {moved};
    agree(definition);
  }
}

TEST_CASE("a body that nothing holds falls on the grid as the parabola says", "[verification]") {
  cases::Case definition = block(cases::Formulation::log_strain, Element::q1_bbar);
  definition.fixed.clear();
  const cases::Solution motion =
      fem_reference::follow(cases::make_scene(definition), fem_reference::default_steps(), Backend::grid);
  const double half_squared = 0.04 * 0.04 / 2;
  for (const Vector3d& moved : motion.displacement)
    CHECK((moved - half_squared * Vector3d(2000, 0, -4000)).norm() < 1e-6); // the block moves by 3.6 mm
}

} // namespace motion_of_two_backends
