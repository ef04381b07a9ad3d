#include "cases/case/read_case.hpp"
#include "cases/mesh/triangle_mesh.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/interact/read_recording.hpp"
#include "compare/interact/replay.hpp"
#include "compare/solve/solve.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace compare;
using Eigen::Vector3d;

namespace {

/// A block in cubes of 10 mm, whose surface has triangles of 1.25 mm.
cases::Scene block() {
  cases::Scene scene = cases::make_scene(cases::read_case_text(R"(schema = 1
name = "block"
[body]
shape = "box"
size = [40, 40, 60]
cells = [4, 4, 6]
[material]
model = "linear_elastic"
youngs_modulus = 0.005
poissons_ratio = 0.3
density = 1000
[[fixed]]
region = "z-"
[[load]]
kind = "gravity"
value = [0, 0, 1e-6]
[dynamics]
scheme = "implicit_euler"
step = 0.1
end = 0.2
[fem]
formulation = "small_strain"
accuracy = "none"
[msm]
design = "moduli"
[[measure]]
name = "pulled"
kind = "displacement"
node = "near 40 20 40"
component = "x"
)",
                                                               "block.toml"));
  scene.surface = cases::outer_surface(cases::make_box_mesh({40, 40, 60}, {32, 32, 48}));
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

TEST_CASE(
    "a recorded patch is pulled to a limit as cells are halved, and would not be by forces on its nodes",
    "[verification]") {
  const std::string rows = "1,0.1,40,20,40,15,0.01,0,0.002\n2,0.2,40,20,40,15,0.01,0,0.002\n";
  cases::Scene scene = with_recording(block(), recording_header + "\n" + rows, "pulls.csv");
  // Second order has 4; this place has 3.95, in a sphere of 18 mm 3.3. One of 10 mm, a cell's edge, is too
  // small for the coarse mesh to have an order.
  CHECK(ratio_of_changes(scene) >= 3);
  // The same forces left on the nodes of the body's own cells: each halving changes more than the one before.
  for (cases::Scene::AppliedLoad& load : scene.loads) load.points.clear();
  CHECK(ratio_of_changes(scene) < 1);
}
