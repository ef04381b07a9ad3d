#include "compare/export/export_springs.hpp"

#include "cases/case/read_case.hpp"
#include "compare/provenance/call_program.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <sstream>

using namespace springproof;

using compare::ExportTarget;
using Eigen::Vector3d;

// The defect tested for: an exported scene that nobody ran. No package here has SOFA, so the test's own
// program (run_sofa_scene.py) solves what scene.py adds to the graph, with the equations and thresholds that
// SOFA's components have. Other places checked: CSV and VTU, which state that they have no time, and whose
// forces are rebuilt (export_springs_test.cpp).
namespace {

std::string sofa_block_with(double nu) {
  return R"(schema = 1
name = 'block'
[body]
shape = 'box'
size = [20, 10, 10]
cells = [2, 1, 1]
[material]
model = 'linear_elastic'
youngs_modulus = 0.1
poissons_ratio = )" +
         std::to_string(nu) + "\n";
}
const std::string sofa_block = sofa_block_with(0.25);

const char* const block_design = R"(
[msm]
design = '{design}'
[[measure]]
name = 'end'
kind = 'displacement'
node = 'x+ y+ z+'
component = 'z'
)";

const std::string block_held = "[[fixed]]\nregion = 'x-'\n";
const std::string block_pulled = "[[load]]\nregion = 'x+'\nkind = 'traction'\nvalue = [0.001, 0, 0.003]\n";

std::string block_in_time(const std::string& scheme, const std::string& more = "") {
  return fmt::format("[dynamics]\nscheme = '{}'\nstep = 0.002\nend = 0.04\n{}", scheme, more);
}

cases::Scene block_scene(const std::string& text, const std::string& design = "moduli") {
  return cases::make_scene(
      cases::read_case_text(text + fmt::format(block_design, fmt::arg("design", design)), "block.toml"));
}

/// Exports a scene, and has it solved from what it adds to SOFA's graph. Free nodes keep a relative 1e-8 of
/// the forces in SOFA, 1e-9 here.
/// @return the largest distance of a node from ours, over the largest displacement
double distance_from_ours(const cases::Scene& scene) {
  const TemporaryFolder folder;
  const msm::Problem problem = compare::exported_problem(scene);
  const auto motion = compare::exported_motion(scene);
  compare::check_expressible(ExportTarget::sofa, "block", problem, motion);
  compare::export_springs(folder.path, ExportTarget::sofa, "block", problem, compare::exported_body(scene),
                          motion);
  const int n_steps = motion ? motion->dynamics.n_steps() : 1;
  const auto end = compare::call_program(
      {{"/usr/bin/python3", SPRINGPROOF_SOURCE_DIR "/tests/compare/export/run_sofa_scene.py",
        folder.path.string(), std::to_string(n_steps)},
       folder.path.string(),
       {"PYTHONDONTWRITEBYTECODE=1"}});
  REQUIRE(end.has_value());
  INFO(end->said);
  REQUIRE(end->status == 0);
  std::optional<msm::DesignResult> design;
  const compare::Answer ours = compare::solve_springs(scene, 1, design);
  REQUIRE(ours.converged());
  std::istringstream lines(end->said);
  double largest = 0, distance = 0;
  for (const Vector3d& u : ours.solution.displacement) {
    Vector3d theirs;
    char comma = ',';
    REQUIRE(lines >> theirs.x() >> comma >> theirs.y() >> comma >> theirs.z());
    largest = std::max(largest, u.norm());
    distance = std::max(distance, (theirs - u).norm());
  }
  REQUIRE(largest > 0.01); // mm: far above what solvers leave
  return distance / largest;
}

} // namespace

TEST_CASE("a static scene's first step is the equilibrium, of loads and of moved regions", "[verification]") {
  CHECK(distance_from_ours(block_scene(sofa_block + block_held + block_pulled)) < 1e-6);
  CHECK(distance_from_ours(block_scene(sofa_block + block_held + block_pulled +
                                       "[[moved]]\nregion = 'x+'\ndisplacement = [2, 0, 1]\n"
                                       "components = ['x', 'z']\n")) < 1e-6);
}

TEST_CASE("a scene with volume terms, midlines and springs of other laws answers as the case does",
          "[verification]") {
  const std::string design = GENERATE("hybrid", "matched", "midline", "biquadratic");
  INFO(design);
  const auto distance = [&](const std::string& text) {
    return distance_from_ours(block_scene(sofa_block_with(0.35) + text, design));
  };
  // Within the reach of Newton's method without the line search that SOFA has.
  const std::string pulled = "[[load]]\nregion = 'x+'\nkind = 'traction'\nvalue = [0.001, 0, 0.001]\n";
  CHECK(distance(block_held + pulled) < 1e-6);
  CHECK(distance(block_held + "[[moved]]\nregion = 'x+'\ndisplacement = [2, 0, 1]\n") < 1e-6);
  CHECK(distance("density = 1000\nmass_damping = 20\n" + block_held + pulled + block_in_time("bdf2")) < 1e-6);
}

TEST_CASE("a scene in time moves as the case does, with its masses, damping, steps and histories",
          "[verification]") {
  const auto [scheme, density] = GENERATE(table<std::string, std::string>(
      {{"implicit_euler", "density = 1000\n"}, {"bdf2", "density = 1300\n"}}));
  INFO(scheme);
  const std::string damped = sofa_block + density + "mass_damping = 20\n";
  const std::string weight =
                        "[[load]]\nkind = 'gravity'\nvalue = [0, 0, -300]\nhistory = { ramp = [0, 0.02] }\n",
                    swing = block_pulled + "history = { sine = 30 }\n",
                    jump = block_pulled + "history = [[0, 1], [0.01, 1], [0.01, 0]]\n";
  CHECK(distance_from_ours(block_scene(damped + block_held + block_pulled + block_in_time(scheme))) < 1e-6);
  CHECK(distance_from_ours(block_scene(damped + block_held + swing + weight + block_in_time(scheme))) < 1e-6);
  CHECK(distance_from_ours(block_scene(damped + block_held + jump +
                                       block_in_time(scheme, "start = 'equilibrium'\n"))) < 1e-6);
  CHECK(distance_from_ours(block_scene(damped + block_pulled + block_in_time(scheme))) < 1e-6); // it flies
  const std::string turned = "[[moved]]\nregion = 'x+'\nangle = 60\naxis = 'x'\ncentre = [20, 5, 5]\n"
                             "history = [[0, 0], [0.03, 1], [0.04, 1.2]]\n";
  CHECK(distance_from_ours(block_scene(damped + block_held + turned + block_in_time(scheme))) < 1e-6);
  const std::string added = "[[mass]]\nregion = 'x+'\nvalue = 0.002\n";
  CHECK(distance_from_ours(block_scene(sofa_block + density + block_held + block_pulled + added +
                                       block_in_time(scheme))) < 1e-6);
}

TEST_CASE("damping by stiffness is that of the body as it is in SOFA: the same of small strains",
          "[verification]") {
  const std::string damped = sofa_block + "density = 1000\nstiffness_damping = 0.0005\n";
  const auto apart = [&](double traction) {
    const std::string load =
        fmt::format("[[load]]\nregion = 'x+'\nkind = 'traction'\nvalue = [0, 0, {}]\n", traction);
    return distance_from_ours(block_scene(damped + block_held + load + block_in_time("implicit_euler")));
  };
  const double large = apart(0.004), small = apart(0.0004);
  CHECK(small < 5e-3);
  CHECK(large < 5e-2);
  CHECK(large > 5 * small); // it is of the order of the strain
}

TEST_CASE(
    "what SOFA does not do as the case's steps do is refused, and other files say that they have no time") {
  const auto refuses = [](const std::string& text, const std::string& message) {
    const cases::Scene scene = block_scene(text);
    CHECK_THROWS_WITH(compare::check_expressible(ExportTarget::sofa, "block",
                                                 compare::exported_problem(scene),
                                                 compare::exported_motion(scene)),
                      Catch::Contains(message) && Catch::Contains("'block'"));
  };
  const std::string moving = sofa_block + "density = 1000\n";
  refuses(moving + block_held + block_pulled + block_in_time("newmark"),
          "steps of newmark (--set 'dynamics={scheme=\"bdf2\"");
  refuses(moving + block_held + block_pulled + block_in_time("generalized_alpha", "rho_infinity = 0.8\n"),
          "generalized_alpha");
  const std::string moved =
      "[[moved]]\nregion = 'x+'\ndisplacement = [1, 0, 0]\nhistory = { ramp = [0, 0.01] }\n";
  refuses(moving + "stiffness_damping = 0.01\n" + block_held + moved + block_in_time("bdf2"),
          "stiffness_damping beside moved");
  refuses(moving + "mass_damping = 3\n" + block_held + block_pulled +
              "[[mass]]\nregion = 'x+'\nvalue = 0.01\n" + block_in_time("bdf2"),
          "mass_damping of some masses");
  const cases::Scene scene =
      block_scene(moving + "stiffness_damping = 0.01\n" + block_held + block_pulled + block_in_time("bdf2"));
  const TemporaryFolder folder;
  for (const ExportTarget target : {ExportTarget::csv, ExportTarget::vtu, ExportTarget::sofa}) {
    const auto said = compare::export_springs(folder.path, target, "block", compare::exported_problem(scene),
                                              compare::exported_body(scene), compare::exported_motion(scene));
    const std::string expected = target == ExportTarget::sofa  ? "of the body as it is in SOFA"
                                 : target == ExportTarget::csv ? "not in it: damping, steps"
                                                               : "not in it: masses, damping, steps";
    CHECK_THAT(said.back(), Catch::Contains(expected));
  }
}
