#include "cases/case/read_case.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/measure/measure.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

using namespace springproof;

using Eigen::Vector3d;

// An angle that wraps. Looked for also in: courses over time (series_of(), whose peaks and swings follow),
// errors in percent (of the values, which are counted now), zero_of() (a size), curvature (an inverse
// radius), turned regions themselves (steps of 30 degrees, in statics and in time).
namespace {

constexpr double radians_of_degree = 3.14159265358979323846 / 180;

/// A bar along x of 40 x 10 x 10 mm, held at x- and otherwise as it is told.
cases::Scene twisted_bar(const std::string& supports, int cells_along = 24) {
  const std::string text = fmt::format(R"(schema = 1
name = 'bar'
[body]
shape = 'box'
size = [40, 10, 10]
cells = [{}, 2, 2]
[material]
model = 'linear_elastic'
youngs_modulus = 0.1
poissons_ratio = 0.3
{}
[[load]]
region = 'x+'
kind = 'traction'
value = [0, 0, 1e-6]
[msm]
design = 'hybrid'
[[measure]]
name = 'end'
kind = 'twist'
node = 'x+ y+ z+'
centre = 'x+ y- z-'
axis = 'x'
[[measure]]
name = 'middle'
kind = 'twist'
node = 'near 20 10 10'
centre = 'near 20 0 0'
axis = 'x'
[[measure]]
name = 'bend'
kind = 'tilt'
top = 'x+ y- z-'
bottom = 'near {} 0 0'
toward = 'z'
up = 'x'
)",
                                       cells_along, supports, 40. - 40. / cells_along);
  return cases::make_scene(cases::read_case_text(text, "bar.toml"));
}

const std::string held_at_x = "[[fixed]]\nregion = 'x-'\n";

template<class Motion>
cases::Solution moved_bar(const cases::Scene& scene, const Motion& motion) {
  cases::Solution solution;
  solution.status = cases::Status::converged;
  for (const Vector3d& x : scene.mesh.nodes) solution.displacement.push_back(motion(x) - x);
  return solution;
}

/// The bar with its sections turned about its axis, by `degrees` at the end.
cases::Solution twisted_by(const cases::Scene& scene, double degrees) {
  const Vector3d axis(0, 5, 5);
  return moved_bar(scene, [&](const Vector3d& x) {
    return Vector3d(axis + Eigen::AngleAxisd(degrees * radians_of_degree * x.x() / 40, Vector3d::UnitX()) *
                               (x - axis));
  });
}

double value_of_bar(int measure, const cases::Scene& scene, const cases::Solution& solution) {
  return compare::evaluate(scene.definition.measures[cases::index(measure)], scene, solution);
}

} // namespace

TEST_CASE("a twist is counted through the body from what holds it, whole turns and all", "[verification]") {
  for (const double degrees : {-900., -254.5, -185., -90., 30., 179., 181., 253.2, 360., 720., 1500.}) {
    INFO(degrees);
    const cases::Scene scene = twisted_bar(held_at_x);
    CHECK(value_of_bar(0, scene, twisted_by(scene, degrees)) == Approx(degrees).epsilon(1e-12).margin(1e-10));
    CHECK(value_of_bar(1, scene, twisted_by(scene, degrees)) ==
          Approx(degrees / 2).epsilon(1e-12).margin(1e-10));
    // Counted from the turned end alone.
    const cases::Scene driven = twisted_bar(
        fmt::format("[[symmetry]]\nplane = 'x-'\n[[moved]]\nregion = 'x+'\nangle = {}\naxis = [-1, 0, 0]\n"
                    "centre = [40, 5, 5]\nsteps = 3\n",
                    -degrees));
    CHECK(value_of_bar(0, driven, twisted_by(driven, degrees)) ==
          Approx(degrees).epsilon(1e-12).margin(1e-10));
    CHECK(value_of_bar(1, driven, twisted_by(driven, degrees)) ==
          Approx(degrees / 2).epsilon(1e-12).margin(1e-10));
  }
}

TEST_CASE("two twists of more than half a turn differ by what they differ by") {
  const cases::Scene scene = twisted_bar(held_at_x);
  const auto error = compare::measure_error_percent(scene.definition.measures[0], scene,
                                                    twisted_by(scene, 253.2), twisted_by(scene, 254.5));
  REQUIRE(error);
  CHECK(*error == Approx(100 * (254.5 / 253.2 - 1)).epsilon(1e-9));
}

TEST_CASE("a tilt is counted too, along a bar that is bent into a ring", "[verification]") {
  const cases::Scene scene = twisted_bar(held_at_x, 40);
  for (const double degrees : {-200., 100., 181., 270., 340.}) {
    const double radius =
        40 / (degrees * radians_of_degree); // mm: radius of the bar's lower fibres about (0, y, radius)
    const auto ring = moved_bar(scene, [&](const Vector3d& x) {
      const double angle = degrees * radians_of_degree * x.x() / 40;
      return Vector3d((radius - x.z()) * std::sin(angle), x.y(), radius - (radius - x.z()) * std::cos(angle));
    });
    CHECK(value_of_bar(2, scene, ring) ==
          Approx(degrees * (1 - 0.5 / 40)).epsilon(1e-9)); // a chord of the last cell
  }
}

TEST_CASE("a body that nothing holds in the plane keeps to half a turn") {
  const cases::Scene scene = twisted_bar("[[fixed]]\nregion = 'x- y- z-'\ncomponents = ['x']\n");
  CHECK(value_of_bar(0, scene, twisted_by(scene, 254.5)) == Approx(254.5 - 360).epsilon(1e-9));
}

TEST_CASE("both models turn an end by 300 degrees, in statics and in time", "[verification][long]") {
  const std::string turned =
      held_at_x + "[[moved]]\nregion = 'x+'\nangle = 300\naxis = 'x'\ncentre = [40, 5, 5]\n";
  for (const bool moves : {false, true}) {
    INFO(moves);
    cases::Case definition = twisted_bar(turned, 8).definition; // cubes: their springs follow the whole turn
    if (moves) {
      cases::Dynamics& dynamics = definition.dynamics.emplace();
      dynamics.scheme.scheme = cases::Scheme::implicit_euler;
      dynamics.step = 0.01;
      dynamics.end = 0.1;
      definition.material_dynamics.density = 1000;
      definition.moved[0].history.points = {{0, 0}, {0.1, 1}};
      for (cases::Measure& measure : definition.measures) measure.over_time = cases::OverTime::end;
    }
    const compare::Comparison comparison = compare::compare_case(definition);
    REQUIRE(comparison.answers.fem.converged());
    REQUIRE(comparison.answers.msm.converged());
    const auto& end = comparison.measures[0];
    CHECK(*end.fem == Approx(300).epsilon(1e-9)); // supports are where they have to be
    CHECK(*end.msm == Approx(300).epsilon(1e-9));
    CHECK(*end.error_percent == Approx(0).margin(1e-7));
    CHECK(*comparison.measures[1].fem == Approx(150).epsilon(0.1)); // half way, but for waves in time
    CHECK(*comparison.measures[1].msm == Approx(150).epsilon(0.1));
  }
}

TEST_CASE("a course of angles goes on where it was") {
  std::vector<double> degrees{170, -170, -60, 60, 179, -100, 170, -170};
  compare::count_turns_in_time(degrees);
  CHECK(degrees == std::vector<double>{170, 190, 300, 420, 539, 620, 530, 550});
}
