#include "compare/solve/springs.hpp"
#include "tests/compare/interact/block.hpp"

#include "cases/mesh/triangle_mesh.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/interact/recording.hpp"
#include "compare/solve/solve.hpp"

#include <catch2/catch.hpp>
#include <sstream>

using namespace springproof;

using namespace compare;
using Eigen::Vector3d;

namespace {

/// A block in cubes of 10 mm, whose surface has triangles of 1.25 mm.
cases::Scene finely_drawn_block() {
  cases::Case definition = block("[4, 4, 6]", "").definition;
  definition.dynamics->step = 0.1;
  definition.dynamics->end = 0.2;
  definition.fem.formulation = cases::Formulation::small_strain;
  std::get<cases::measures::Displacement>(definition.measures.front().kind).node.near = Vector3d(40, 20, 40);
  cases::Scene scene = cases::make_scene(definition);
  const cases::Mesh fine = cases::make_box_mesh({40, 40, 60}, {32, 32, 48});
  scene.surface = cases::triangles_of_faces(fine, cases::boundary_faces(fine));
  scene.definition.surface.emplace();
  return scene;
}

/// Displacement (mm) of the middle of the pulled place at the end, with each cell of the body halved n times.
double pulled(cases::Scene scene, int n) {
  scene.definition.fem.refine = n;
  const Answers answers = solve(scene, {}, solve_fem);
  CAPTURE(answers.fem.solution.message);
  REQUIRE(answers.fem.converged());
  return answers.fem.solution.trajectory->displacement.back().x();
}

/// How many times less the second halving of the cells changes the pulled place than the first.
double ratio_of_changes(const cases::Scene& scene) {
  const double coarse = pulled(scene, 0), fine = pulled(scene, 1), finer = pulled(scene, 2);
  CAPTURE(coarse, fine, finer);
  REQUIRE(coarse > 0.1); // mm: it was pulled
  return (fine - coarse) / (finer - fine);
}

} // namespace

TEST_CASE("a body that is pulled comes to the static equilibrium of the spring's force", "[verification]") {
  for (const std::string cells : {"[3, 3, 4]", "[9, 8, 8]"}) {
    CAPTURE(cells);
    const cases::Scene scene = block(cells);
    PulledBody body(scene, {50, 1e-3, 1});
    const auto held = body.grab(from_right);
    REQUIRE(held);
    CHECK(body.surface().rest.vertices[cases::index(*held)].x() == Approx(40));
    body.drag({20, 0, 5});
    for (int step = 0; step < 400; ++step) body.step();
    REQUIRE(body.troubles().n_failures == 0);
    CHECK(body.force().norm() > 1e-3);

    cases::Scene loaded = scene; // the same force, by the weights of its place
    loaded.loads.clear();
    const auto patch = mechanics::patch_within(
        body.surface(), body.surface().rest.vertices[cases::index(*held)], body.spheres().radius);
    for (const auto& [node, weight] : cases::on_nodes(patch, scene.mesh)) {
      cases::Load load{{}, cases::loads::NodalForce{weight * body.force()}};
      loaded.loads.push_back({{{node}, {}, {}}, load});
    }
    loaded.definition.dynamics.reset();
    const cases::Solution rest = msm::Model(loaded, design_for(loaded).springs).solve();
    const double largest = largest_displacement(body);
    CHECK(largest > 0.5); // mm: it was pulled
    double difference = 0;
    for (std::size_t n = 0; n < rest.displacement.size(); ++n)
      difference = std::max(difference, (rest.displacement[n] - body.displacement()[n]).norm());
    CHECK(difference < 1e-4 * largest); // what 8 s of damping and a tolerance of 1e-6 leave
  }
}

const std::string pulled_by[] = {"scheme = \"implicit_euler\"", "scheme = \"bdf2\""};

TEST_CASE("a spring of any stiffness does not drive an undamped body on") {
  for (const std::string& scheme : pulled_by)
    for (const double stiffness : {1e-2, 1., 1e6}) {
      CAPTURE(scheme, stiffness);
      const cases::Scene scene = block("[3, 3, 4]", "", scheme);
      PulledBody body(scene, {50, stiffness, 1});
      body.step();
      REQUIRE(body.grab(from_right));
      body.drag({10, 0, 0});
      double largest = 0;
      for (int step = 0; step < 1000; ++step) {
        body.step();
        largest = std::max(largest, largest_displacement(body));
      }
      CHECK(body.troubles().n_failures == 0);
      CHECK(largest > 1);
      CHECK(largest <
            21); // a swing without damping goes twice as far as the pointer, and corners a little further
    }
}

TEST_CASE("a stiff spring takes its place to the pointer in one step") {
  for (const std::string cells : {"[3, 3, 4]", "[9, 8, 8]"}) {
    CAPTURE(cells);
    const cases::Scene scene = block(cells);
    PulledBody body(scene, {50, 1e6, 1});
    const int held = body.grab(from_right).value();
    body.drag({2, 0, 1});
    body.step();
    const Vector3d at =
        mechanics::displacement_at(body.surface().vertices[cases::index(held)], body.displacement());
    // The mean of the sphere's part of the surface is there to 1e-5; its middle, by what the part bends.
    CHECK((at - Vector3d(2, 0, 1)).norm() < 0.5);
    CHECK(body.force().norm() > 1e-3); // N
  }
}

TEST_CASE("steps of too few iterations are counted with what they are left with") {
  const auto pulled = [](std::optional<int> iterations) {
    cases::Scene scene = block("[9, 8, 8]");
    scene.definition.msm.iterations_per_step = iterations;
    PulledBody body(scene, {50, 1, 1});
    body.step();
    REQUIRE(body.grab(from_right));
    body.drag({15, 0, 5});
    double largest = 0;
    for (int step = 0; step < 20; ++step) {
      body.step();
      largest = std::max(largest, body.residual());
    }
    CHECK(body.troubles().largest_residual >= largest);
    return std::pair(body.troubles().n_unfinished, largest);
  };
  const auto [n, largest] = pulled(1);
  CHECK(n > 0);
  CHECK(n <= 21);
  CHECK(largest > 1e-2);
  const auto [none, small] = pulled({});
  CHECK(none == 0);
  CHECK(small <= 1e-6);
}

TEST_CASE("schemes that damp nothing are refused, for a pointer that jumps would drive their bodies on") {
  for (const std::string scheme :
       {"scheme = \"newmark\"", "scheme = \"generalized_alpha\"\nrho_infinity = 0.8"})
    CHECK_THROWS_WITH(PulledBody(block("[3, 3, 4]", "", scheme), {50, 1e-3, 1}),
                      Catch::Contains("\"implicit_euler\" or \"bdf2\""));
}

TEST_CASE("a ray beside the body holds nothing, and a body begins anew where it began") {
  const cases::Scene scene = block("[3, 3, 4]");
  PulledBody body(scene, {50, 1e-3, 1});
  CHECK_FALSE(body.grab({{200, 20, 500}, {-1, 0, 0}}));
  CHECK_FALSE(body.held());
  REQUIRE(body.grab(from_right));
  body.drag({1e9, 0, 0}); // the body's size counts
  for (int step = 0; step < 20; ++step) body.step();
  CHECK(largest_displacement(body) > 0.1);
  CHECK(body.time() == Approx(0.4));
  body.restart();
  CHECK(largest_displacement(body) == 0);
  CHECK_FALSE(body.held());
  CHECK(body.n_steps() == 0);
}

TEST_CASE("a recording replays in springs as it was pulled, and in finite elements it pulls as well",
          "[verification]") {
  for (const std::string& scheme : pulled_by) {
    CAPTURE(scheme);
    const cases::Scene scene = block("[3, 3, 4]", "mass_damping = 30", scheme, "1");
    PulledBody body(scene, {50, 1e-3, 1});
    std::ostringstream rows;
    rows.precision(17);
    rows << recording_header << '\n';
    for (int step = 1; step <= 50; ++step) { // the whole length of the case
      if (step == 5) {
        REQUIRE(body.grab(from_right));
        body.drag({15, 3, 0});
      }
      if (step == 30) body.release();
      body.step();
      if (body.force().isZero(0)) continue;
      const Vector3d& place = body.surface().rest.vertices[cases::index(*body.held())];
      rows << body.n_steps() << ',' << 0.02 * static_cast<double>(body.n_steps()) << ',' << place.x() << ','
           << place.y() << ',' << place.z() << ',' << body.spheres().radius << ',' << body.force().x() << ','
           << body.force().y() << ',' << body.force().z() << '\n';
    }
    const Answers answers = solve(with_recording(scene, rows.str(), "pulls.csv"), {}, solve_fem);
    CAPTURE(answers.msm.solution.message);
    REQUIRE(answers.msm.converged());
    REQUIRE(answers.fem.converged());
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < body.displacement().size(); ++n) {
      const Vector3d& replayed = answers.msm.solution.displacement[n];
      largest = std::max(largest, replayed.norm());
      difference = std::max(difference, (replayed - body.displacement()[n]).norm());
    }
    CHECK(largest > 0.01);
    CHECK(difference < 1e-4 * largest); // tolerances 1e-6 and 1e-9 of the largest force, over 50 steps
    const cases::Trajectory& fem = *answers.fem.solution.trajectory;
    CHECK(fem.displacement[25].norm() > 0.1); // the watched corner
  }
}

TEST_CASE("a replay pulls a node on planes of symmetry with what it was pulled with", "[verification]") {
  const std::string text = R"(schema = 1
name = "on_planes"
[body]
shape = "box"
size = [10, 10, 10]
cells = [1, 1, 1]
[material]
model = "linear_elastic"
youngs_modulus = 1e-12
poissons_ratio = 0.3
density = 1000
[[symmetry]]
plane = "x-"
[[symmetry]]
plane = "y-"
[[load]]
kind = "gravity"
value = [0, 0, 1e-9]
[dynamics]
scheme = "implicit_euler"
step = 0.01
end = 0.01
[msm]
design = "moduli"
[[measure]]
name = "corner"
kind = "displacement"
node = "x- y- z-"
component = "z"
)";
  const cases::Scene scene = cases::make_scene(cases::read_case_text(text, "planes.toml"));
  const std::string row = "1,0.01,0,0,0,0,0,0,0.001\n"; // N, on one vertex
  const Answers answers =
      solve(with_recording(scene, recording_header + "\n" + row, "pulls.csv"), {}, solve_fem);
  REQUIRE(answers.msm.converged());
  // A free mass of an eighth of a gram: F h²/m, in mm; gravity and the springs do 1e-13 of it.
  CHECK(answers.msm.solution.displacement[0].z() == Approx(0.001 * 1e-4 / (1e-6 / 8)).epsilon(1e-6));
}

TEST_CASE("what is no recording of a case is refused with its line") {
  const cases::Scene scene = block("[3, 3, 4]");
  const std::string header = recording_header + "\n";
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {"", "has no pull"},
           {header, "has no pull"},
           {"x,y\n", "a.csv:1: must be the header"},
           {header + "1,0.02,0,0,0,0,0\n", "a.csv:2: must be nine numbers"},
           {header + "1,0.02,0,0,0,5,0,0,nan\n", "a.csv:2: must be nine numbers"},
           {header + "1,0.02,0,0,0,5,0,0,1e300\n", "a.csv:2: must be nine numbers"},
           {header + "1.5,0.03,0,0,0,5,0,0,1\n", "a.csv:2: step must be a whole number"},
           {header + "2,0.04,0,0,0,5,0,0,1\n2,0.04,0,0,0,5,0,0,1\n", "a.csv:3: step must be"},
           {header + "2,0.05,0,0,0,5,0,0,1\n", "a.csv:2: time is 0.05 s, must be 0.04 s"},
           {header + "2,0.04,0,0,0,-1,0,0,1\n", "a.csv:2: radius must be 0 or above"},
           {header + "2,0.04,500,0,0,5,0,0,1\n",
            "a.csv: step 2: no vertex of the case's surface lies within 5 mm"},
           {header + "51,1.02,0,0,0,5,0,0,1\n", "ends at 1.02 s: dynamics.end is 1 s"}}) {
    CAPTURE(text);
    CHECK_THROWS_WITH(with_recording(scene, text, "a.csv"), Catch::Contains(says));
  }
}

TEST_CASE(
    "a recorded patch is pulled to a limit as cells are halved, and would not be by forces on its nodes",
    "[verification]") {
  const std::string rows = "1,0.1,40,20,40,15,0.01,0,0.002\n2,0.2,40,20,40,15,0.01,0,0.002\n";
  cases::Scene scene = with_recording(finely_drawn_block(), recording_header + "\n" + rows, "pulls.csv");
  // Second order has 4; this place has 3.95, in a sphere of 18 mm 3.3. One of 10 mm, a cell's edge, is too
  // small for the coarse mesh to have an order.
  CHECK(ratio_of_changes(scene) >= 3);
  // The same forces left on the nodes of the body's own cells: each halving changes more than the one before.
  for (cases::Scene::AppliedLoad& load : scene.loads) load.points.clear();
  CHECK(ratio_of_changes(scene) < 1);
}
