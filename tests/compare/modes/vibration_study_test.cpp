#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"
#include "compare/modes/modes.hpp"
#include "compare/peers/calculix.hpp"
#include "compare/solve/solvers.hpp"
#include "compare/solve/springs.hpp"
#include "msm/moving_springs.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

using namespace springproof;

namespace {

/// A bar of a square section along x, of water and 0.1 MPa, that nothing holds.
const std::string free_bar = R"(schema = 1
name = "bar"
[body]
shape = "box"
size = [40, 10, 10]
cells = [8, 2, 2]
[material]
model = "linear_elastic"
youngs_modulus = 0.1
poissons_ratio = 0.3
density = 1000
[msm]
design = "hybrid"
)";

/// The bar, held at one end or moving freely.
cases::Scene bar(bool is_held) {
  const std::string held = "[[fixed]]\nregion = \"x-\"\n",
                    moving = "[dynamics]\nscheme = \"newmark\"\nstep = 0.001\nend = 0.001\n",
                    load = "[[load]]\nkind = \"gravity\"\nvalue = [0, 0, -9.81]\n"
                           "[fem]\naccuracy = \"none\"\n";
  return cases::make_scene(cases::read_case_text(free_bar + (is_held ? held : moving) + load, "bar.toml"));
}

const double wave = std::sqrt(0.1 / 1e-9); // mm/s, along a rod

} // namespace

TEST_CASE("a case for its vibrations alone needs neither supports nor loads nor [dynamics]",
          "[verification]") {
  const TemporaryFolder folder;
  const std::string file = folder.write("free.toml", free_bar);
  CHECK_THROWS_WITH(cases::read_case(file), Catch::Contains("nothing holds the body"));
  const auto free = cases::make_scene(cases::read_case(file, {}, cases::Purpose::vibrations));
  const compare::VibrationStudy alone = compare::study_vibrations(free, {}, 4),
                                in_time = compare::study_vibrations(bar(false), {}, 4);
  CHECK(alone.fem.n_rigid == 6);
  CHECK((alone.fem.hertz - in_time.fem.hertz).cwiseAbs().maxCoeff() <= 1e-9 * in_time.fem.hertz.maxCoeff());
  CHECK(run_program("eigen " + file + " --modes 2").status == 0);
}

TEST_CASE("both models of a free bar have its rigid motions and the vibrations of a rod", "[verification]") {
  const compare::VibrationStudy study = compare::study_vibrations(bar(false), {}, 12);
  CHECK(study.fem.n_rigid == 6);
  REQUIRE(study.designs.size() == 1);
  const compare::DesignVibrations& springs = study.designs.front();
  CHECK(springs.msm.n_rigid == 6);
  REQUIRE(!springs.modes.empty());
  // Bending in two planes of a square section comes first, as one space.
  CHECK(springs.modes.front().dimension == 2);
  CHECK(springs.modes.front().overlap > 0.99);
  // Some mode is the lowest along the rod, c/(2 L); its sides' inertia takes a little from it.
  const double along = wave / (2 * 40);
  double nearest = 1;
  for (const compare::MatchedModes& mode : springs.modes)
    if (mode.dimension == 1) nearest = std::min(nearest, std::abs(mode.fem_hz / along - 1));
  CHECK(nearest < 0.03);
  for (const compare::MatchedModes& mode : springs.modes) {
    CHECK(mode.overlap >= 0);
    CHECK(mode.overlap <= 1);
    CHECK(mode.error_percent.value() == Approx(100 * (*mode.msm_hz / mode.fem_hz - 1)).margin(1e-9));
  }
}

TEST_CASE("a model's vibrations overlap with themselves, degenerate ones too") {
  const cases::Scene scene = bar(true);
  const Eigen::VectorXd masses = compare::mode_masses(scene);
  const compare::VibrationStudy study = compare::study_vibrations(scene, {}, 10);
  // Turned within its space of two, the first pair is as good a pair.
  compare::Vibrations turned = study.fem;
  const auto spaces = compare::cluster(turned.hertz, 0, compare::same_frequency);
  REQUIRE(spaces.front().dimension == 2);
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Eigen::VectorXd first = turned.shapes.col(0), second = turned.shapes.col(1);
  turned.shapes.col(0) = c * first + s * second;
  turned.shapes.col(1) = c * second - s * first;
  const auto matched = compare::match_modes(study.fem, turned, masses, 10);
  REQUIRE(!matched.empty());
  for (const compare::MatchedModes& mode : matched) {
    CHECK(mode.overlap == Approx(1).margin(1e-9));
    CHECK(std::abs(mode.error_percent.value()) < 1e-9);
  }
}

TEST_CASE("designs are held against the same finite elements, one that cannot serve by its reason") {
  const compare::VibrationStudy study =
      compare::study_vibrations(bar(true), {cases::Design::hybrid, cases::Design::transverse}, 6);
  REQUIRE(study.designs.size() == 2);
  CHECK(study.designs[0].refusal.empty());
  CHECK(!study.designs[1].refusal.empty());
  const nlohmann::ordered_json document = compare::vibrations_to_json(study);
  CHECK(document["designs"].size() == 2);
  REQUIRE(document["modes"].size() >= 1);
  for (const char* key : {"fem_hz", "msm_hz", "overlap", "error_percent"})
    CHECK(document["modes"][0][key].is_number());
}

TEST_CASE("frequencies by CalculiX are ours", "[verification]") {
  cases::Scene scene = bar(true);
  scene.definition.fem.element = cases::Element::q1;
  // CalculiX 2.20, *FREQUENCY with C3D8 on the same mesh and supports, Hz.
  const double theirs[] = {10.49744, 10.49744, 38.82315, 54.46865, 54.46865, 63.46296, 117.9702, 129.1332};
  const compare::VibrationStudy ours = compare::study_vibrations(scene, {}, 8);
  for (Eigen::Index mode = 0; mode < 8; ++mode)
    CHECK(ours.fem.hertz[mode] == Approx(theirs[mode]).epsilon(1e-5));
}

TEST_CASE("what has no mass does not vibrate") {
  cases::Scene scene = bar(true);
  scene.definition.material_dynamics.density.reset();
  CHECK_THROWS_AS(compare::study_vibrations(scene, {}, 4), cases::InputError);
}

TEST_CASE("what is held at all nodes does not vibrate") {
  cases::Scene scene = bar(true);
  scene.constrained.front().selection.nodes.resize(scene.mesh.nodes.size());
  std::iota(scene.constrained.front().selection.nodes.begin(),
            scene.constrained.front().selection.nodes.end(), 0);
  CHECK_THROWS_WITH(compare::study_vibrations(scene, {}, 4), Catch::Contains("nothing vibrates"));
}

TEST_CASE("quadratic finite elements on a finer mesh are compared on the body's nodes", "[verification]") {
  cases::Scene scene = bar(true);
  scene.definition.fem.element = cases::Element::q2;
  const compare::VibrationStudy fine = compare::study_vibrations(scene, {}, 4);
  // Euler and Bernoulli's cantilever of slenderness 4, less what shear and rotation take.
  const double beam = 0.5596 / (40. * 40.) * wave * std::sqrt(10. * 10 / 12);
  REQUIRE(!fine.designs.front().modes.empty());
  const compare::MatchedModes& bending = fine.designs.front().modes.front();
  CHECK(bending.fem_hz < beam);
  CHECK(bending.fem_hz > 0.9 * beam);
  CHECK(bending.overlap > 0.99);
}

TEST_CASE("springs' frequencies come to the finite elements' limit with lumped and with consistent masses",
          "[verification][long]") {
  const auto scene_of = [](bool is_cantilever, int n) {
    cases::Scene scene = bar(is_cantilever);
    auto definition = scene.definition;
    definition.material = cases::LinearElastic{0.1, 0.35};
    definition.body =
        is_cantilever ? cases::Box{{40, 10, 10}, {4 * n, n, n}} : cases::Box{{10, 10, 10}, {n, n, n}};
    return cases::make_scene(definition);
  };
  for (const bool is_cantilever : {true, false}) {
    const int n_modes = is_cantilever ? 7 : 2; // further modes of the coarse cube come in another order
    const auto hertz_of = [&](const cases::Scene& scene, const mechanics::VibratingBody& body) {
      return compare::vibrations_of(body, compare::mode_masses(scene), n_modes).hertz;
    };
    cases::Scene fine = scene_of(is_cantilever, 6);
    fine.definition.fem.element = cases::Element::q2;
    const Eigen::VectorXd limit = hertz_of(fine, compare::solvers().vibrating_elements(fine));
    const auto errors = [&](int n, cases::PointMass mass) -> Eigen::VectorXd {
      cases::Scene scene = scene_of(is_cantilever, n);
      scene.definition.msm.mass = mass;
      const msm::Lattice lattice = msm::make_lattice(scene.mesh, compare::design_for(scene).springs);
      return (hertz_of(scene, msm::vibrating_body(scene, lattice)).array() / limit.array() - 1).abs();
    };
    Eigen::VectorXd of_kind[2];
    for (const auto mass : {cases::PointMass::cells, cases::PointMass::consistent}) {
      INFO(cases::name_of(mass) << (is_cantilever ? ", cantilever" : ", free cube"));
      const Eigen::VectorXd coarse = errors(3, mass), finer = errors(6, mass);
      CAPTURE(coarse.transpose(), finer.transpose());
      // Orders from 1.3 to 2: springs of the surface belong to fewer cells.
      CHECK((finer.array() < 0.42 * coarse.array()).all());
      CHECK(finer.maxCoeff() < 0.04);
      of_kind[mass == cases::PointMass::consistent] = finer;
    }
    // Torsion of the cantilever; the cube's lowest pair.
    for (const Eigen::Index mode :
         is_cantilever ? std::vector<Eigen::Index>{2, 6} : std::vector<Eigen::Index>{0})
      CHECK(of_kind[1][mode] < 0.5 * of_kind[0][mode]);
  }
}
