#include "msm/model.hpp"

#include "cases/case/error.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using Eigen::Vector3d;

namespace {

const double degrees = 180 / std::acos(-1.0);

struct Cube {
  cases::Scene scene;
  cases::Solution solution;
  Cube(std::vector<cases::Load> loads, const msm::CellStiffness& stiffness)
      : scene(cases::make_scene(bodies::clamped_box({10, 10, 10}, std::move(loads)))),
        solution(msm::Model(scene, {stiffness}).solve()) {}
  Vector3d at(double x, double y, double z) const {
    cases::Region node;
    node.near = Vector3d(x, y, z);
    const auto n = static_cast<std::size_t>(cases::select_node(scene.mesh, node));
    return scene.mesh.nodes[n] + solution.displacement[n];
  }
  double tilt(double x) const {
    const Vector3d up = at(x, 0, 10) - at(x, 0, 0);
    return degrees * std::atan2(up.x(), up.z());
  }
  double twist(double x, double y) const {
    const Vector3d now = at(x, y, 10) - at(5, 5, 10), rest(x - 5, y - 5, 0);
    return degrees *
           std::atan2(rest.x() * now.y() - rest.y() * now.x(), rest.x() * now.x() + rest.y() * now.y());
  }
};

using bodies::thesis_cell;
constexpr double digit = 5.01e-4; // half of the last digit that the reference prints

} // namespace

// Reference for the three tests: an independent solver's values for k = (31, 47, 33) N/m, three decimals.
TEST_CASE("the cube under tension is as high as an independent solver finds it", "[verification]") {
  const Cube small(bodies::tensile(0.010), thesis_cell), large(bodies::tensile(0.050), thesis_cell);
  CHECK(small.at(5, 5, 10).z() == Approx(10.372).margin(digit));
  CHECK(small.at(0, 0, 10).z() == Approx(10.578).margin(digit));
  CHECK(large.at(5, 5, 10).z() == Approx(11.717).margin(digit));
  CHECK(large.at(0, 0, 10).z() == Approx(12.463).margin(digit));
}

TEST_CASE("the cube under shear leans as an independent solver finds it", "[verification]") {
  const Cube small(bodies::shear(0.002), thesis_cell), large(bodies::shear(0.010), thesis_cell);
  CHECK(small.tilt(0) == Approx(3.276).margin(digit));
  CHECK(small.tilt(10) == Approx(3.346).margin(digit));
  CHECK(large.tilt(0) == Approx(15.501).margin(digit));
  CHECK(large.tilt(10) == Approx(17.209).margin(digit));
}

TEST_CASE("the cube under torsion turns as an independent solver finds it", "[verification]") {
  const Cube small(bodies::torsion(0.005), thesis_cell), large(bodies::torsion(0.025), thesis_cell);
  CHECK(small.twist(10, 5) == Approx(3.264).margin(digit));
  CHECK(small.twist(10, 10) == Approx(4.977).margin(digit));
  CHECK(large.twist(10, 5) == Approx(15.736).margin(digit));
  CHECK(large.twist(10, 10) == Approx(22.425).margin(digit));
}

namespace {

cases::Scene box_scene(const std::array<int, 3>& cells, std::vector<cases::Load> loads) {
  return cases::make_scene(bodies::clamped_box(cells, std::move(loads)));
}

/// The error that solving ends with.
cases::SolveError solve_error(const cases::Scene& scene, const msm::CellStiffness& stiffness) {
  try {
    msm::Model(scene, {stiffness}).solve();
  } catch (const cases::SolveError& error) {
    return error;
  }
  FAIL("an equilibrium was reported");
  return cases::SolveError("");
}

} // namespace

TEST_CASE("a lattice of negative springs is unstable at rest") {
  const cases::SolveError error =
      solve_error(box_scene({2, 2, 2}, bodies::tensile(0.01)), bodies::cell(-31, -47, -33));
  CHECK(error.outcome() == cases::Outcome::unstable_equilibrium);
  CHECK(error.load_reached() == 0);
}

// Other places checked for this defect: the grid's path (never says unstable), vibrations ("unstable at rest"
// with the lowest omega² alone), volume terms and tetrahedra (named as such).
TEST_CASE(
    "what makes a lattice unstable at rest is said: negative springs, or springs that are pressed together") {
  const cases::Scene scene = box_scene({2, 2, 2}, bodies::tensile(0.01));
  CHECK_THAT(solve_error(scene, bodies::cell(-31, -47, -33)).what(),
             Catch::EndsWith("because of springs of negative stiffness"));
  CHECK_THAT(solve_error(scene, bodies::cell(31, 47, 33, -9)).what(),
             Catch::EndsWith("because of volume terms or tetrahedra of negative stiffness"));
  // Networks of a lattice's springs, pressed together by their rest lengths.
  const auto pressed = [&](const msm::CellStiffness& cell, double factor) {
    msm::Network springs;
    for (const auto& [i, j, spring] : msm::make_lattice(scene.mesh, {cell}).links)
      springs.push_back({i, j, spring.stiffness, factor * spring.rest_length, {}});
    return springs;
  };
  const auto error_of = [&](const msm::Network& springs) {
    try {
      msm::Model(scene, springs).solve();
    } catch (const cases::SolveError& error) {
      return error;
    }
    return cases::SolveError("none");
  };
  const msm::Network network = pressed(bodies::cell(31, 47, 33), 3);
  const std::string all = std::to_string(network.size());
  CHECK_THAT(error_of(network).what(),
             Catch::EndsWith("because springs are pressed together there: the points of " + all + " of " +
                             all + " are nearer to each other than the spring's rest length"));
  // Too few springs, in a file of few digits: what hardly presses is not to blame.
  const msm::Network loose = pressed(bodies::cell(31, 0, 0), 1 + 1e-6);
  CHECK(error_of(loose).outcome() == cases::Outcome::mechanism);
  CHECK_THAT(error_of(loose).what(), Catch::EndsWith("meets no stiffness"));
}

TEST_CASE("a lattice of edges alone is a mechanism") {
  const cases::SolveError error =
      solve_error(box_scene({3, 3, 3}, bodies::tensile(0.01)), bodies::cell(31, 0, 0));
  CHECK(error.outcome() == cases::Outcome::mechanism);
}

TEST_CASE(
    "a lattice whose stiffness is nothing, or lost in double precision, is a mechanism that ends at once") {
  for (const msm::Path path : {msm::Path::direct, msm::Path::multigrid})
    for (const double stiffness : {0., 1e-320, 1e-300}) {
      CAPTURE(stiffness, path == msm::Path::direct);
      mechanics::EquilibriumSettings settings;
      settings.lowest_eigenvalue = mechanics::LowestEigenvalue::report; // hard cases do so too
      msm::Model model(box_scene({10, 10, 10}, bodies::tensile(0.01)), {bodies::cell(stiffness, 0, 0)},
                       {path, 1});
      try {
        model.solve(settings);
        FAIL("an equilibrium was reported");
      } catch (const cases::SolveError& error) {
        CHECK(error.outcome() == cases::Outcome::mechanism);
      }
    }
}

TEST_CASE("springs of any size but nothing are solved alike: the multigrid cycle has its own scale") {
  const cases::Scene scene = box_scene({10, 10, 10}, bodies::tensile(0.01));
  const cases::Solution usual = msm::Model(scene, {thesis_cell}, {msm::Path::multigrid, 1}).solve();
  for (const int exponent : {-150, 150}) { // beyond single precision
    const double factor = std::ldexp(1, exponent);
    cases::Scene scaled = scene;
    for (auto& applied : scaled.loads) applied.load.scale(factor);
    const msm::CellStiffness cell{factor * thesis_cell.edge, factor * thesis_cell.face_diagonal,
                                  factor * thesis_cell.internal_diagonal, 0};
    const cases::Solution found = msm::Model(scaled, {cell}, {msm::Path::multigrid, 1}).solve();
    CHECK(largest_difference(found, usual) == 0); // powers of two change no digit
  }
}

TEST_CASE("a thin column and a nearly incompressible cube are sound, whatever multigrid makes of them") {
  SECTION("of a thousand cells") {
    const cases::Scene column = box_scene({1, 1, 1000}, {bodies::nodal_force("z+", {0, 0, 1e-4})});
    const cases::Solution found = msm::Model(column, {thesis_cell}).solve();
    CHECK(found.outcome == cases::Outcome::stable_equilibrium);
    const cases::Scene piece = box_scene({1, 1, 100}, {bodies::nodal_force("z+", {0, 0, 1e-4})});
    const double of_piece = msm::Model(piece, {thesis_cell}).solve().displacement.back().z();
    CHECK(found.displacement.back().z() == Approx(10 * of_piece).epsilon(0.01)); // the clamped end is in both
  }
  SECTION("of Poisson's ratio 0.4999999") {
    const cases::Scene cube = box_scene({8, 8, 8}, bodies::tensile(0.001)); // multigrid would take it
    const msm::CellStiffness cell = bodies::cell(45, 10, 60, 5e5);
    for (const msm::Path path : {msm::Path::automatic, msm::Path::direct}) {
      const cases::Solution found = msm::Model(cube, {cell}, {path, 1}).solve();
      CHECK(found.outcome == cases::Outcome::stable_equilibrium);
      CHECK(largest_volume_difference(found, msm::Model(cube, {cell}, {msm::Path::direct, 1}).solve()) <
            1e-6);
    }
  }
}

TEST_CASE("a body that nothing holds is a mechanism") {
  cases::Case loose = bodies::clamped_box({2, 2, 2}, bodies::tensile(0.01));
  loose.fixed = {{bodies::region("z- x- y-")}}; // one node: it may still turn about it
  const cases::SolveError error = solve_error(cases::make_scene(loose), thesis_cell);
  CHECK(error.outcome() == cases::Outcome::mechanism);
}

TEST_CASE(
    "the path from rest ends at a limit point: below it an equilibrium is stable, above it there is none") {
  const msm::CellStiffness soft = bodies::cell(23.3, 6.5, 22.7);
  const double full = 0.010;
  const cases::SolveError error = solve_error(box_scene({4, 4, 4}, bodies::shear(full)), soft);
  REQUIRE(error.outcome() == cases::Outcome::limit_point);
  const double limit = full * error.load_reached();
  CHECK(error.residual() <= 1e-9);
  mechanics::EquilibriumSettings settings;
  settings.lowest_eigenvalue = mechanics::LowestEigenvalue::report;
  const auto lowest = [&](double load) {
    const cases::Solution found =
        msm::Model(box_scene({4, 4, 4}, bodies::shear(load)), {soft}).solve(settings);
    CHECK(found.outcome == cases::Outcome::stable_equilibrium);
    return found.lowest_eigenvalue.value();
  };
  const double far = lowest(0.9 * limit), near = lowest(0.999 * limit);
  CHECK(near > 0);
  CHECK(near < 0.5 * far); // the stiffness against the snap goes to zero with the square root of what is left
  CHECK(solve_error(box_scene({4, 4, 4}, bodies::shear(1.002 * limit)), soft).outcome() ==
        cases::Outcome::limit_point);
}

TEST_CASE("a straight bar pressed past its buckling load is found bent, and stable") {
  const cases::Scene scene = box_scene({2, 2, 24}, {bodies::nodal_force("z+", {0, 0, -0.0004})});
  mechanics::EquilibriumSettings settings;
  settings.lowest_eigenvalue = mechanics::LowestEigenvalue::report;
  const cases::Solution found = msm::Model(scene, {thesis_cell}).solve(settings);
  CHECK(found.outcome == cases::Outcome::stable_equilibrium);
  CHECK(found.lowest_eigenvalue.value() > 0);
  CHECK(found.inverted_cells == 0);
  CHECK(found.residual <= 1e-9);                         // what the solver promises
  CHECK(found.displacement.back().head<2>().norm() > 1); // mm, against a side of 2
}

TEST_CASE("the same equilibrium is found from disturbed positions") {
  const cases::Scene scene = box_scene({4, 4, 4}, bodies::tensile(0.05));
  msm::Model model(scene, {thesis_cell});
  const cases::Solution from_rest = model.solve();
  const msm::Points start = bodies::disturbed(msm::Points(scene.mesh.nodes.size(), Vector3d::Zero()), 0.3);
  const cases::Solution from_there = model.solve({}, start);
  for (std::size_t n = 0; n < start.size(); ++n)
    CHECK((from_there.displacement[n] - from_rest.displacement[n]).norm() <
          1e-6); // mm; residual 1e-9 of 1 N over 1e-3 N/mm
}

TEST_CASE("a body that one node holds is a mechanism, whatever path looks for its equilibrium") {
  cases::Case loose = bodies::clamped_box({5, 5, 5}, bodies::tensile(0.01));
  loose.fixed = {{bodies::region("z- x- y-")}};
  const cases::Scene scene = cases::make_scene(loose);
  for (const msm::Path path : {msm::Path::direct, msm::Path::multigrid})
    for (const double volume : {0.0, 0.14}) {
      INFO("k_v = " << volume);
      try {
        msm::Model(scene, {bodies::cell(31, 47, 33, volume)}, {path, 1}).solve();
        FAIL("an equilibrium was reported");
      } catch (const cases::SolveError& error) {
        CHECK(error.outcome() == cases::Outcome::mechanism);
      }
    }
}

TEST_CASE("a body half of which is a million times stiffer is solved as far as rounding allows") {
  const cases::Scene scene = box_scene({6, 6, 6}, bodies::tensile(0.05));
  std::vector<msm::CellStiffness> cells(scene.mesh.cells.size(), thesis_cell);
  for (std::size_t c = cells.size() / 2; c < cells.size(); ++c) cells[c] = bodies::cell(31e6, 47e6, 33e6);
  for (const msm::Path path : {msm::Path::direct, msm::Path::multigrid}) {
    const cases::Solution found = msm::Model(scene, cells, {path, 1}).solve();
    CHECK(found.outcome == cases::Outcome::stable_equilibrium);
    // 1e5 N/mm times 1e-15 mm, some 20 such forces added up, over a load of 0.35 N: 6e-9
    CHECK(found.residual <= 1e-7);
    // The stiff half moves as a rigid body: its height stays 3 mm.
    const double top = 6 + found.displacement.back().z();
    const auto middle = static_cast<std::size_t>(7 * 7 * 3 + 48); // the vertex below it, at z = 3
    CHECK(top - (3 + found.displacement[middle].z()) == Approx(3).margin(1e-5)); // a millionth of the strain
  }
}

TEST_CASE("a lattice turned inside out stays so without a volume term, and is turned back by one") {
  const cases::Scene scene = box_scene({5, 5, 5}, bodies::shear(0.002));
  msm::Points mirrored;
  for (const Vector3d& node : scene.mesh.nodes) mirrored.emplace_back(0, 0, -2 * node.z());
  const cases::Solution springs = msm::Model(scene, {thesis_cell}).solve({}, mirrored);
  CHECK(springs.inverted_cells == 125);
  CHECK(springs.outcome == cases::Outcome::stable_equilibrium);
  msm::Model hybrid(scene, {bodies::cell(20, 25, 20, 0.14)});
  const cases::Solution turned = hybrid.solve({}, mirrored), from_rest = hybrid.solve();
  CHECK(turned.inverted_cells == 0);
  for (std::size_t n = 0; n < mirrored.size(); ++n)
    CHECK((turned.displacement[n] - from_rest.displacement[n]).norm() < 1e-6); // mm, as below
}

TEST_CASE("a start inside out is refused by volume terms that have no forces there") {
  const cases::Scene scene = box_scene({8, 8, 8}, bodies::shear(0.002));
  msm::Points mirrored;
  for (const Vector3d& node : scene.mesh.nodes) mirrored.emplace_back(0, 0, -2 * node.z());
  msm::CellStiffness springs = bodies::hybrid_cell;
  springs.exponents = {-1, -1, -1};
  for (const msm::Path path : {msm::Path::direct, msm::Path::multigrid}) {
    try {
      msm::Model(scene, {springs}, {path, 1}).solve({}, mirrored);
      FAIL("accepted");
    } catch (const cases::SolveError& error) {
      CHECK(error.outcome() == cases::Outcome::refused);
      CHECK_THAT(error.what(), Catch::Contains("the start has cells turned inside out"));
      CHECK(error.residual() == 0); // none: a number all the same
    }
  }
}

TEST_CASE("a body without unknowns is where its supports are, by every solver") {
  // The same for finite elements: tests/fem_reference/model_test.cpp; for whole programs: attempts.py.
  for (const cases::Solver solver :
       {cases::Solver::newton, cases::Solver::force_scaling, cases::Solver::fire, cases::Solver::lbfgs})
    for (const msm::Path path : {msm::Path::direct, msm::Path::multigrid}) {
      cases::Case definition = bodies::clamped_box({1, 1, 1}, {});
      cases::Moved moved;
      moved.region = bodies::region("z+");
      moved.displacement = {0, 0, 0.1};
      definition.moved = {moved};
      definition.msm.solver = solver;
      msm::ModelOptions options;
      options.path = path;
      const cases::Scene scene = cases::make_scene(definition);
      const cases::Solution found = msm::Model(scene, {thesis_cell}, options).solve();
      CHECK(found.unknowns == 0);
      for (std::size_t n = 0; n < 8; ++n)
        CHECK(found.displacement[n] == Vector3d(0, 0, scene.mesh.nodes[n].z() > 0.5 ? 0.1 : 0));
    }
}
