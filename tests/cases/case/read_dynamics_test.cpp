#include "cases/case/readers.hpp"

#include "tests/fuzz/mutate.hpp"
#include "tests/support/case_text.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
using namespace case_text;

TEST_CASE("a dynamic case is read") {
  const Case c = read_text(dynamic_case);
  REQUIRE(c.dynamics);
  CHECK(c.dynamics->scheme.scheme == Scheme::newmark);
  CHECK(c.dynamics->scheme.beta == 0.25);
  CHECK(c.dynamics->scheme.gamma == 0.5);
  CHECK(c.dynamics->step == 0.01);
  CHECK(c.dynamics->end == 2);
  CHECK(c.dynamics->n_steps() == 200);
  CHECK(c.dynamics->write_every == 1);
  CHECK(c.dynamics->start == MotionStart::equilibrium);
  CHECK(c.material_dynamics.density == 1070);
  CHECK(c.material_dynamics.mass_damping == 0.5);
  CHECK(c.material_dynamics.stiffness_damping == 0.001);
  REQUIRE(c.loads.size() == 2);
  CHECK(std::get<loads::Gravity>(c.loads[0].kind).value == Eigen::Vector3d(0, 0, -9.81));
  CHECK(c.loads[0].history.at(0) == 1);
  CHECK(c.loads[1].history.just_before(0) == 1);
  CHECK(c.loads[1].history.at(0) == 0);
  REQUIRE(c.masses.size() == 1);
  CHECK(c.masses[0].region.name == "x+ z+");
  CHECK(c.masses[0].mass == 0.052);
  CHECK(c.fem.mass == ElementMass::lumped);
  CHECK(c.msm.mass == PointMass::uniform);
  CHECK_FALSE(c.msm.iterations_per_step);
  CHECK(read_text(replaced(dynamic_case, "mass = 'uniform'", "mass = 'uniform'\niterations_per_step = 6"))
            .msm.iterations_per_step == 6);
  CHECK_FALSE(c.fem.has_auto_accuracy);
  CHECK(c.measures[0].over_time == OverTime::frequency);
}

TEST_CASE("what a dynamic case may leave out has the usual values") {
  Case c = read_text(replaced(dynamic_case, "over_time = 'frequency'\n", ""));
  CHECK(c.measures[0].over_time == OverTime::end);
  c = read_text(replaced(dynamic_case, "[fem]\nmass = 'lumped'\n[msm]\nmass = 'uniform'\n", ""));
  CHECK(c.fem.mass == ElementMass::consistent);
  CHECK(c.msm.mass == PointMass::cells);
  c = read_text(replaced(dynamic_case, "end = 2\nstart = 'equilibrium'", "end = 20.5"));
  CHECK(c.dynamics->start == MotionStart::rest);
  CHECK(c.dynamics->write_every == 11); // 2050 steps, 200 bodies at most
  c = read_text(replaced(dynamic_case, "'newmark'", "'newmark'\ngamma = 0.6"));
  CHECK(c.dynamics->scheme.beta == Approx(1.1 * 1.1 / 4));
  c = read_text(replaced(dynamic_case, "'newmark'", "'generalized_alpha'\nrho_infinity = 0.8"));
  CHECK(c.dynamics->scheme.rho_infinity == 0.8);
}

TEST_CASE("a history is a list of times and factors, a ramp, a step, or a sine") {
  const auto history = [](const std::string& text) {
    return read_text(replaced(dynamic_case, "[[0, 1], [0, 0]]", text)).loads[1].history;
  };
  CHECK(history("[[0, 0], [0.5, 2], [1, 0]]").at(0.25) == 1);
  CHECK(history("{ ramp = [1, 2] }").at(1.5) == 0.5);
  CHECK(history("{ ramp = [1, 2] }").at(3) == 1);
  CHECK(history("{ step = 0 }").just_before(0) == 0);
  CHECK(history("{ step = 0 }").at(0) == 1);
  CHECK(history("{ sine = 2 }").at(0.125) == Approx(1));
}

TEST_CASE("a body that begins at rest needs nothing that holds it, one that begins in equilibrium does") {
  const std::string flying = replaced(dynamic_case, "[[fixed]]\nregion = 'x-'\n", "");
  CHECK(read_text(replaced(flying, "'equilibrium'", "'rest'")).fixed.empty());
  check_case_refused(flying, 1, "fixed", {"is missing", "nothing holds the body"});
}

TEST_CASE("a mistake in [dynamics] is refused where it is made") {
  const auto refused = mistakes_in(dynamic_case);
  refused("scheme = 'newmark'\n", "", 14, "dynamics.scheme",
          {"is missing", "\"implicit_euler\" | \"newmark\""});
  refused("'newmark'", "'newmarc'", 15, "dynamics.scheme", {"did you mean \"newmark\"?"});
  refused("'newmark'", "'bdf2'\nbeta = 0.25", 16, "dynamics.beta", {"scheme = \"newmark\""});
  refused("'newmark'", "'newmark'\ngamma = 0.4", 16, "dynamics.gamma", {"from 0.5 to 1"});
  refused("'newmark'", "'newmark'\nbeta = 0.1", 16, "dynamics.beta", {"gamma/2", "0.25", "unstable"});
  refused("'newmark'", "'newmark'\nrho_infinity = 1", 16, "dynamics.rho_infinity", {"generalized_alpha"});
  refused("'newmark'", "'generalized_alpha'", 14, "dynamics.rho_infinity", {"is missing", "from 0 to 1"});
  refused("'newmark'", "'generalized_alpha'\nrho_infinity = 1.1", 16, "dynamics.rho_infinity",
          {"from 0 to 1"});
  refused("step = 0.01", "step = 0", 16, "dynamics.step", {"1e-9 to 1000000 (s)"});
  refused("step = 0.01", "step = 1e-200", 16, "dynamics.step", {"1e-9"});
  refused("step = 0.01\n", "", 14, "dynamics.step", {"is missing"});
  refused("end = 2", "end = 2.005", 17, "dynamics.end", {"whole number of steps of 0.01 s"});
  refused("end = 2", "end = 0.001", 17, "dynamics.end", {"whole number of steps"});
  refused("end = 2", "end = 1e9", 17, "dynamics.end", {"1 to 10000000"});
  refused("end = 2", "end = 2\nwrite_every = 0", 18, "dynamics.write_every", {"whole number from 1"});
  refused("'equilibrium'", "'deformed'", 18, "dynamics.start", {"\"rest\" | \"equilibrium\""});
  refused("end = 2", "end = 2\nsteps = 4", 18, "dynamics.steps", {"did you mean \"step\"?"});
}

TEST_CASE("a mistake in masses, gravity or damping is refused where it is made") {
  const auto refused = mistakes_in(dynamic_case);
  refused("density = 1070\n", "", 7, "material.density", {"is missing", "(kg/m³)", "beside [dynamics]"});
  refused("density = 1070", "density = 1.07e-9", 11, "material.density", {"0.001 to 1000000 (kg/m³)"});
  refused("mass_damping = 0.5", "mass_damping = -1", 12, "material.mass_damping", {"0 or above (1/s)"});
  refused("stiffness_damping = 0.001", "stiffness_damping = '1'", 13, "material.stiffness_damping", {"(s)"});
  refused("value = 0.052", "value = 0", 31, "mass[0].value", {"(kg)"});
  refused("region = 'x+ z+'\n", "", 29, "mass[0].region", {"is missing"});
  refused("kind = 'gravity'", "kind = 'gravity'\nregion = 'x+'", 23, "load[0].region", {"whole body"});
  refused("[0, 0, -9.81]", "-9.81", 23, "load[0].value", {"three finite numbers (m/s²)"});
  refused("'lumped'", "'lumpy'", 33, "fem.mass", {"\"consistent\" | \"lumped\""});
  refused("'uniform'", "'uniform'\niterations_per_step = 0", 36, "msm.iterations_per_step",
          {"from 1 to 1000"});
  refused("'uniform'", "'lumped'", 35, "msm.mass", {"\"cells\" | \"uniform\" | \"consistent\""});
  refused("[dynamics]",
          "[[region_material]]\naxis = 'x'\nto = 50\nmodel = 'linear_elastic'\n"
          "youngs_modulus = 1\npoissons_ratio = 0.3\n[dynamics]",
          14, "region_material[0]", {"density is missing"});
}

TEST_CASE("a Prony series is read, and refused where it has no meaning") {
  const auto with = [](const std::string& prony) {
    return replaced(dynamic_case, "mass_damping = 0.5", "prony = " + prony);
  };
  const Case c = read_text(with("[{ g = 0.2, tau = 0.1 }, { g = 0.1, k = 0.3, tau = 2 }]"));
  REQUIRE(c.material_dynamics.prony.size() == 2);
  CHECK(c.material_dynamics.prony[0].k == 0);
  CHECK(c.material_dynamics.prony[1].g == 0.1);
  CHECK(c.material_dynamics.prony[1].k == 0.3);
  CHECK(c.material_dynamics.prony[1].tau == 2);
  const auto refused = [&](const std::string& prony, const std::string& key, const std::string& text) {
    INFO(prony);
    CHECK_THROWS_WITH(read_text(with(prony)),
                      Catch::Contains("material.prony" + key) && Catch::Contains(text));
  };
  refused("[{ g = -0.2, tau = 0.1 }]", "[0].g", "from 0 and below 1");
  refused("[{ g = 1, tau = 0.1 }]", "[0].g", "from 0 and below 1");
  refused("[{ g = 0.2, k = -1, tau = 0.1 }]", "[0].k", "from 0 and below 1");
  refused("[{ g = 0.2, tau = 0 }]", "[0].tau", "1e-9 to 1e9 (s)");
  refused("[{ g = 0.2 }]", "[0].tau", "is missing");
  refused("[{ g = 0.2, tau = 1, e = 2 }]", "[0].e", "is not a key here");
  refused("[{ g = 0.6, tau = 1 }, { g = 0.4, tau = 2 }]", "", "add up to less than 1");
  refused("0.2", "", "a list of { g = ..., k = ..., tau = ... }");
}

TEST_CASE("a network, which has no cells, is refused consistent masses") {
  const TemporaryFolder folder;
  const std::string file = folder.write("springs.csv", "0,1,1\n");
  const auto with = [&](const std::string& mass) {
    return replaced(dynamic_case, "mass = 'uniform'",
                    "design = 'network'\nfile = '" + file + "'\nmass = '" + mass + "'");
  };
  CHECK(read_text(with("cells")).msm.mass == PointMass::cells);
  CHECK_THROWS_WITH(read_text(with("consistent")),
                    Catch::Contains("msm.mass") && Catch::Contains("belong to no cell"));
}

TEST_CASE("a mistake in a history is refused where it is made") {
  const std::string history = "[[0, 1], [0, 0]]";
  const auto refused = mistakes_in(dynamic_case);
  refused(history, "1", 28, "load[1].history", {"ramp", "step", "sine"});
  refused(history, "[]", 28, "load[1].history", {"[time (s), factor]"});
  refused(history, "[[0, 1], [0]]", 28, "load[1].history[1]", {"two finite numbers"});
  refused(history, "[[1, 1], [0.5, 0]]", 28, "load[1].history[1]", {"do not descend"});
  refused(history, "[[1, 1], [1, 0], [1, 2]]", 28, "load[1].history[2]", {"at most two"});
  refused(history, "[[-1, 1], [1, 0]]", 28, "load[1].history[0]", {"times from 0"});
  refused(history, "{ ramp = [1, 1] }", 28, "load[1].history.ramp", {"the smaller first"});
  refused(history, "{ step = -1 }", 28, "load[1].history.step", {"from 0 (s)"});
  refused(history, "{ sine = 1e308 }", 28, "load[1].history.sine", {"at most 1e9"});
  refused(history, "{ sine = 0 }", 28, "load[1].history.sine", {"above 0 (Hz)"});
  refused(history, "{ sine = 1, step = 1 }", 28, "load[1].history", {"one of them"});
  refused(history, "{ sin = 1 }", 28, "load[1].history.sin", {"did you mean \"sine\"?"});
  refused(history, "{}", 28, "load[1].history", {"{ ramp = [from, to] }"});
}

TEST_CASE("a sine that the steps cannot see is refused beside the longest step that can") {
  const std::string history = "[[0, 1], [0, 0]]"; // the steps are 0.01 s
  CHECK(read_text(replaced(dynamic_case, history, "{ sine = 49 }")).loads[1].history.frequency == 49);
  const auto refused = mistakes_in(dynamic_case);
  refused(history, "{ sine = 50 }", 14, "dynamics", {"step is 0.01 s", "load[1].history", "50 Hz: 0.01 s"});
  refused(history, "{ sine = 100 }", 14, "dynamics", {"below half a period", "100 Hz: 0.005 s"});
}

TEST_CASE("a support has a motion that begins where the body is, and does not jump") {
  const std::string load = "[[load]]\nregion = 'x+'\nkind = 'total_force'\nvalue = [0, 1, 0]\n",
                    moved = "[[moved]]\nregion = 'x+'\ndisplacement = [0, 0, 1]\n",
                    text = replaced(dynamic_case, load, moved);
  const std::string none = replaced(text, "history = [[0, 1], [0, 0]]\n", "");
  check_case_refused(none, 25, "moved[0].region", {"history is missing"});
  check_case_refused(text, 25, "moved[0].region", {"history jumps"});
  const std::string held = replaced(text, "[[0, 1], [0, 0]]", "[[0, 1], [1, 0]]");
  CHECK(read_text(held).moved[0].history.at(0) == 1);
  check_case_refused(replaced(held, "'equilibrium'", "'rest'"), 25, "moved[0].region",
                     {"must be 0", "\"rest\""});
}

TEST_CASE("in motion the surface that a case names is a measure, and there is none without it") {
  const TemporaryFolder folder;
  const std::string surface = "[surface]\nfile = '" + folder.write("skin.stl", "") + "'\n",
                    expected = "[[expect]]\nmeasure = 'surface'\nerror_percent = [0, 40]\n"
                               "reference = 'regression'\nreason = 'a test'\n";
  const Case c = read_text(dynamic_case + surface + expected);
  REQUIRE(c.expectations.size() == 1);
  CHECK(c.expectations[0].measure == surface_measure);
  check_case_refused(dynamic_case + expected, 43, "expect[0].measure", {"\"drop\""});
  check_case_refused(good_case + surface + expected, 40, "expect[1].measure", {"\"alpha_1\""});
  check_case_refused(replaced(dynamic_case, "'drop'", "'surface'") + surface, 37, "measure[0].name",
                     {"another name"});
}

TEST_CASE("what has no meaning in a static case, or none in a dynamic one, is refused") {
  const std::string density = "poissons_ratio = 0.35\ndensity = 1000";
  const auto refused = mistakes_in(good_case);
  refused("poissons_ratio = 0.35", density + "\nmass_damping = 1", 13, "material.mass_damping",
          {"[dynamics]"});
  refused("poissons_ratio = 0.35", density + "\nprony = [{ g = 0.2, tau = 0.1 }]", 13, "material.prony",
          {"without [dynamics]"});
  refused("value = [0.002, 0, 0.0]", "value = [0.002, 0, 0.0]\nhistory = { step = 1 }", 18, "load[0].history",
          {"[dynamics]"});
  refused("toward = 'x'", "toward = 'x'\nover_time = 'peak'", 32, "measure[0].over_time", {"[dynamics]"});
  refused("refine = 1", "refine = 1\nmass = 'lumped'", 22, "fem.mass", {"density"});
  refused("split = 0.8", "split = 0.8\niterations_per_step = 6", 26, "msm.iterations_per_step",
          {"[dynamics]"});
  refused("split = 0.8", "split = 0.8\nmass = 'cells'", 26, "msm.mass", {"density"});
  refused("region = 'z+'\nkind = 'nodal_force'", "kind = 'gravity'", 8, "material.density",
          {"is missing", "\"gravity\""});
  CHECK(read_text(replaced(good_case, "poissons_ratio = 0.35", density)).material_dynamics.density == 1000);
  const auto refused_in_motion = mistakes_in(dynamic_case);
  refused_in_motion("mass = 'lumped'", "mass = 'lumped'\naccuracy = 'auto'", 34, "fem.accuracy",
                    {"--converge"});
  refused_in_motion("mass = 'lumped'", "mass = 'lumped'\nformulation = 'auto'", 32, "fem",
                    {"formulation", "[dynamics]"});
  for (const std::string solver : {"fire", "snes"})
    refused_in_motion("mass = 'uniform'", "mass = 'uniform'\nsolver = '" + solver + "'", 34, "msm",
                      {"\"" + solver + "\"", "\"newton\""});
  refused_in_motion("kind = 'displacement'\nnode = 'x+ y- z+'\ncomponent = 'z'",
                    "kind = 'displacement_field_l2'", 39, "measure[0].over_time", {"of the end"});
}

TEST_CASE("300 damaged dynamic cases each end in a case or in one line that says what is wrong") {
  fuzz::Random random(20261122);
  int n_refused = 0, n_read = 0;
  for (int i = 0; i < 300; ++i) {
    const std::string text = fuzz::mutated(dynamic_case, random);
    INFO("number " << i << ":\n" << text);
    try {
      read_case_text(text, "beam.toml");
      ++n_read;
    } catch (const InputError& error) {
      ++n_refused;
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
    } // anything else fails the test
  }
  CHECK(n_refused > 150);
  CHECK(n_read > 10);
}

TEST_CASE("loads that are 0 until the end, and motions, are refused") {
  const std::string gravity = "kind = 'gravity'\nvalue = [0, 0, -9.81]\n",
                    late = "history = [[0, 0], [2.5, 0], [2.5, 1]]\n";
  const std::string still =
      replaced(replaced(dynamic_case, gravity, gravity + late), "history = [[0, 1], [0, 0]]\n", late);
  CHECK_THROWS_WITH(read_text(still), Catch::Contains("nothing would move"));
  CHECK_NOTHROW(read_text(replaced(still, "[2.5, 0], [2.5, 1]", "[1.9, 0], [1.9, 1]")));
}
