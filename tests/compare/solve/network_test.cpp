#include "cases/case/read_case.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/modes/modes.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/report/pages.hpp"
#include "compare/solve/springs.hpp"
#include "compare/write/write.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <sstream>
#include <utility>

using namespace springproof;

namespace {

/// The thesis's cube under its large shear, as a scene of other springs.
cases::Scene cube_of(const std::vector<std::string>& settings) {
  return cases::make_scene(
      cases::read_case(compare::cases_folder() + "/thesis/linear_elastic/cube_shear_large.toml", settings));
}

cases::Solution solved(const cases::Scene& scene) {
  std::optional<msm::DesignResult> design;
  return compare::solve_springs(scene, 1, design).solution;
}

/// The lines of a lattice's links.
std::string lines_of(const msm::Lattice& lattice) {
  std::string text = "a,b,stiffness_N_per_m\n";
  for (const msm::Link& link : lattice.links)
    text += fmt::format("{},{},{}\n", link.i, link.j, 1e3 * link.spring.stiffness);
  return text;
}

} // namespace

TEST_CASE("a network of the cube's own springs answers as the built-in lattice does", "[verification]") {
  const TemporaryFolder folder;
  const cases::Scene built_in = cube_of({});
  const msm::DesignResult design = compare::design_for(built_in);
  const std::string file =
      folder.write("springs.csv", lines_of(msm::make_lattice(built_in.mesh, design.springs)));
  cases::Scene network = built_in;
  network.definition.msm = {};
  network.definition.msm.design = cases::Design::network;
  network.definition.msm.network = cases::NamedFile{file};
  network = cases::make_scene(network.definition);
  REQUIRE(network.network.size() > 10000);
  const cases::Solution found = solved(network),
                        expected = msm::Model(built_in, design.springs, {msm::Path::direct}).solve();
  REQUIRE(expected.status == cases::Status::converged);
  REQUIRE(found.status == cases::Status::converged);
  double largest = 0;
  for (const Eigen::Vector3d& u : expected.displacement) largest = larger(largest, u.norm());
  CHECK(largest_difference(found, expected) <= 1e-9 * largest); // the same sums in another order
}

TEST_CASE("a truss of two springs that snaps through has the reaction and energy of the closed form",
          "[verification]") {
  constexpr double half_span = 100, height = 20, stiffness = 1;
  const double rest = std::hypot(half_span, height);
  for (int w = 4; w <= 40; w += 4) {
    CAPTURE(w);
    const cases::Scene scene =
        cases::make_scene(cases::read_case(compare::cases_folder() + "/studies/von_mises_truss/case.toml",
                                           {fmt::format("moved[0].displacement=[0, 0, {}]", -w)}));
    const cases::Solution found = solved(scene);
    REQUIRE(found.status == cases::Status::converged);
    const double z = height - w, length = std::hypot(half_span, z);
    const double reaction = 2 * stiffness * (length - rest) * z / length,
                 energy = stiffness * std::pow(length - rest, 2);
    // Both are differences of lengths, of which 1e-14 is rounding.
    CHECK(found.fields->reaction[2].z() == Approx(reaction).margin(1e-9));
    CHECK(found.fields->total_energy == Approx(energy).margin(1e-9));
  }
}

TEST_CASE("a truss carries a load below its limit, and snaps through above it", "[verification]") {
  // Its limit is the maximum of 2 k (L0 - L) z/L over z: 0.301944 N at z = 11.42 mm.
  const TemporaryFolder folder;
  for (const char* file : {"nodes.csv", "springs.csv"})
    folder.write(file, content(compare::cases_folder() + "/studies/von_mises_truss/" + file));
  const auto under = [&](double force) {
    const std::string text = R"(schema = 1
name = "truss"
[body]
shape = "network"
nodes = "nodes.csv"
springs = "springs.csv"
[[fixed]]
region = "z-"
[[fixed]]
region = "z+"
components = ["y"]
[[load]]
region = "z+"
kind = "nodal_force"
value = [0, 0, )" + fmt::format("{}]\n", -force);
    return solved(cases::make_scene(cases::read_case_text(text, (folder.path / "case.toml").string())));
  };
  for (const auto& [force, is_through] : {std::pair{0.3, false}, std::pair{0.31, true}}) {
    CAPTURE(force);
    const cases::Solution found = under(force);
    REQUIRE(found.status == cases::Status::converged);
    CHECK_FALSE(found.is_unstable());
    const double z = 20 + found.displacement[2].z(), length = std::hypot(100, z);
    CHECK((z < 0) == is_through);
    if (!is_through) CHECK(z > 11.42);
    // Newton's method stops at 1e-9 of the load.
    CHECK(2 * (length - std::hypot(100, 20)) * z / length == Approx(-force).epsilon(1e-7));
  }
}

TEST_CASE("a network's vibrations are those of its masses", "[verification]") {
  const TemporaryFolder folder;
  folder.write("nodes.csv", "0,0,0,1\n1,0,0,2\n2,0,0,1\n");
  folder.write("springs.csv", "0,1,3000\n1,2,5000\n");
  const std::string text = R"(schema = 1
name = "oscillator"
[body]
shape = "network"
nodes = "nodes.csv"
springs = "springs.csv"
[[fixed]]
region = "x-"
[[fixed]]
region = "x+"
[[fixed]]
region = "near 1 0 0"
components = ["y", "z"]
)";
  const cases::Scene scene =
      cases::make_scene(cases::read_case(folder.write("case.toml", text), {}, cases::Purpose::vibrations));
  const compare::VibrationStudy study = compare::study_vibrations(scene, {}, 3);
  REQUIRE(study.designs.size() == 1);
  CHECK(study.designs[0].refusal.empty());
  REQUIRE(study.designs[0].msm.hertz.size() == 1);
  const double omega = std::sqrt((3000. + 5000) / 2); // 1/s
  CHECK(study.designs[0].msm.hertz[0] == Approx(omega / (2 * std::acos(-1.))).epsilon(1e-9));
}

namespace {

/// A network in a bar of finite elements, of whose nodes one is askew in a cell.
struct Bar : TemporaryFolder {
  Bar() {
    write("nodes.csv", "0,0,0\n10,0,0\n0,4,0\n10,4,0\n0,0,4\n10,0,4\n5.1,1.7,2.9\n");
    std::string springs;
    for (int a = 0; a < 7; ++a)
      for (int b = 0; b < a; ++b) springs += fmt::format("{},{},100\n", a, b);
    write("springs.csv", springs);
  }
  /// @param boundary  supports, motions and loads
  compare::Comparison compared(const std::string& boundary,
                               const std::vector<std::string>& settings = {}) const {
    return compare::compare_case(cases::read_case(write("case.toml", body + boundary + measures), settings));
  }

  const std::string body = R"(schema = 1
name = "bar"
[body]
shape = "network"
nodes = "nodes.csv"
springs = "springs.csv"
[material]
model = "linear_elastic"
youngs_modulus = 0.1
poissons_ratio = 0.25
[fem]
formulation = "small_strain"
element = "q1"
[fem.body]
shape = "box"
size = [10, 4, 4]
cells = [3, 2, 2]
)";
  const std::string measures = R"([[measure]]
name = "along"
kind = "displacement"
node = "near 5.1 1.7 2.9"
component = "x"
[[measure]]
name = "across"
kind = "displacement"
node = "near 5.1 1.7 2.9"
component = "y"
)";
};

/// Stretches it by 1 % between planes on which it slides.
const std::string stretch = R"([[symmetry]]
plane = "x-"
[[symmetry]]
plane = "y-"
[[symmetry]]
plane = "z-"
[[moved]]
region = "x+"
components = ["x"]
displacement = [0.1, 0, 0]
)";

/// Bends it.
const std::string bend = R"([[fixed]]
region = "x-"
[[load]]
region = "x+"
kind = "total_force"
value = [0, 1e-3, 0]
)";

} // namespace

TEST_CASE("finite elements beside a network have their own displacement at its nodes", "[verification]") {
  const Bar bar;
  const compare::Comparison comparison = bar.compared(stretch);
  REQUIRE(comparison.answers.fem.converged());
  REQUIRE(comparison.answers.msm.converged());
  REQUIRE(comparison.measures.size() == 2);
  // A linear displacement is interpolated exactly, by linear and by quadratic functions.
  CHECK(comparison.measures[0].fem.value() == Approx(0.051).epsilon(1e-7));
  CHECK(comparison.measures[1].fem.value() == Approx(-0.25 * 0.01 * 1.7).epsilon(1e-7));
  CHECK(comparison.measures[0].interpolation_error.value() <= 1e-9);
  REQUIRE(comparison.answers.interpolated);
  CHECK(comparison.answers.interpolated->n_outside == 0);
  // Files and pages have its springs as lines.
  std::ostringstream vtu;
  compare::write_vtu(vtu, comparison);
  CHECK_THAT(vtu.str(), Catch::Contains("NumberOfCells=\"21\""));
  const auto views =
      compare::views_to_json({compare::view_of(comparison, "bar", compare::overlay_of(comparison, "bar"))});
  REQUIRE(views["bodies"].size() == 1);
  CHECK(views["bodies"][0]["corners"] == 2);
  CHECK(views["bodies"][0]["faces"].size() == 42);
  CHECK_THROWS_WITH(bar.compared(stretch, {"fem.body.size=[1, 1, 1]"}),
                    Catch::Contains("body.nodes: node") && Catch::Contains("outside of [fem.body]"));
}

TEST_CASE("the interpolation's error beside a network is about what finer cells take from it",
          "[verification]") {
  const Bar bar;
  const auto with_cells = [&](const char* cells) {
    return bar.compared(bend,
                        {"fem.element=q2", "fem.accuracy=none", std::string("fem.body.cells=") + cells});
  };
  const compare::Comparison coarse = with_cells("[3, 2, 2]"), fine = with_cells("[6, 4, 4]");
  REQUIRE(coarse.measures.size() == 2);
  for (std::size_t m = 0; m < 2; ++m) {
    // Quadratic elements have the same displacement at their nodes on both, to a tenth of this.
    const double change = std::abs(coarse.measures[m].fem.value() - fine.measures[m].fem.value());
    CHECK(coarse.measures[m].interpolation_error.value() > change / 2);
    CHECK(coarse.measures[m].interpolation_error.value() < 2 * change);
  }
}
