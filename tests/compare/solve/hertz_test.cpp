// Tools on half spaces, whose forces are known in closed form.

#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/quarter_block.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace compare;
using quarter_block::Grading;

namespace {

constexpr double youngs_modulus = 0.01, nu = 0.3; // MPa

cases::Case small_strains(cases::Element element) {
  cases::Case definition;
  definition.material = cases::LinearElastic{youngs_modulus, nu};
  definition.fem.formulation = cases::Formulation::small_strain;
  definition.fem.element = element;
  return definition;
}

/// A sphere that is pressed in until the contact has the radius of 1 mm, by Hertz's law small against its
/// own.
constexpr double sphere_radius = 20, indentation = 1 / sphere_radius; // a² = R d

cases::Case pressed_by_sphere(cases::Element element) {
  cases::Case definition = small_strains(element);
  definition.tools = {
      quarter_block::pressed_down(cases::tools::Sphere{sphere_radius}, {0, 0, sphere_radius}, indentation)};
  return definition;
}

/// Force of the whole sphere, N.  Source: K. L. Johnson, Contact Mechanics (1985), eq. 4.23
double hertz() {
  return 4. / 3 * youngs_modulus / (1 - nu * nu) * std::sqrt(sphere_radius) * std::pow(indentation, 1.5);
}

/// Force of the tool on the whole body, of which a quarter is modelled, N.
double force_of(const Answer& answer) {
  INFO(answer.solution.message);
  REQUIRE(answer.converged());
  return -4 * answer.solution.tools.front().force.z();
}

double fem_force(const cases::Case& definition, const Grading& grading) {
  return force_of(solve_fem_as_given(quarter_block::make(definition, grading)));
}

/// Force of a flat punch over that of the closed form for a disc of the area that is pressed. The rim is
/// half-way between two nodes of an axis. No other node is as near to it as the indentation is deep: it
/// would come out at the punch's side.
/// Source: K. L. Johnson, Contact Mechanics (1985), section 3.4: F = 2 a d E / (1 - nu²)
double punch_over_closed_form(int n_in_radius, double growth) {
  constexpr double radius = 1, depth = 1e-4, block = 129; // mm
  const double size = radius / (n_in_radius + 0.5);
  cases::Case definition = small_strains(cases::Element::q1);
  definition.tools = {quarter_block::pressed_down(cases::tools::Punch{radius, -Eigen::Vector3d::UnitZ()},
                                                  Eigen::Vector3d::Zero(), depth)};
  const Grading grading{size, 2 * n_in_radius,
                        static_cast<int>(std::ceil(std::log(block / size) / std::log(growth))), growth};
  const Answer answer = solve_fem_as_given(quarter_block::make(definition, grading));
  const double force = force_of(answer), area = 4 * answer.solution.tools.front().area;
  return force / (2 * std::sqrt(area / 3.14159265358979) * depth * youngs_modulus / (1 - nu * nu));
}

double msm_force(const cases::Case& definition, const Grading& grading) {
  std::optional<msm::DesignResult> design;
  return force_of(solve_springs(quarter_block::make(definition, grading), 1, design));
}

} // namespace

TEST_CASE("a sphere on a half space meets Hertz's force at the finite elements' limit",
          "[verification][long]") {
  // Cells of one size under the contact, and beyond cells that grow: the finer mesh halves these alone, on
  // which the force depends. A block of 129 mm and more is stiffer than the half space by less than 0.5 %.
  const cases::Case definition = pressed_by_sphere(cases::Element::q1);
  const double coarse = fem_force(definition, {1. / 4, 6, 8, 2}) / hertz(),
               fine = fem_force(definition, {1. / 4, 6, 16, std::sqrt(2.)}) / hertz();
  CHECK(fine < coarse);
  CHECK((4 * fine - coarse) / 3 == Approx(1).epsilon(0.01)); // second order in the cells
}

TEST_CASE("a flat punch meets its closed form at the finite elements' limit", "[verification][release]") {
  const double coarse = punch_over_closed_form(4, 2), fine = punch_over_closed_form(8, 2),
               slowly = punch_over_closed_form(4, std::sqrt(2.));
  CHECK(coarse < fine);
  // First order in the cells under the punch, whose stress is infinite at the rim: sizes are 1/4.5 and 1/8.5.
  const double limit = fine + (fine - coarse) * 4.5 / 4;
  // Second order in the cells that grow.
  const double of_growth = (4 * slowly / coarse - 1) / 3;
  CHECK(limit * of_growth == Approx(1).epsilon(0.02));
}

TEST_CASE("springs of cubes, eight to a contact radius, have the force of finite elements to 5 %",
          "[verification][release]") {
  // A block of three contact radii is no half space: both models have the same one.
  const Grading cubes{1. / 8, 24, 0, 1};
  cases::Case definition = pressed_by_sphere(cases::Element::q1_bbar);
  const double fem = fem_force(definition, cubes);
  for (const cases::Design design : {cases::Design::midline, cases::Design::hybrid}) {
    definition.msm.design = design;
    INFO(cases::name_of(design));
    CHECK(msm_force(definition, cubes) == Approx(fem).epsilon(0.05));
  }
}
