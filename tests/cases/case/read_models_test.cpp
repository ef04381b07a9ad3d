#include "cases/case/readers.hpp"

#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
using namespace case_text;

namespace {

const LinearElastic soft{0.3, 0.35};
const TransverselyIsotropic fibrous{60e-3, 20e-3, 0.45, 0.7, 12e-3, Eigen::Vector3d::UnitZ()};

} // namespace

TEST_CASE("a nearly incompressible material is refused for elements that lock and for the linear method") {
  const std::string ogden = R"(schema = 1
name = "bar"
[body]
shape = "box"
size = [4, 4, 16]
cells = [4, 4, 16]
[material]
model = "ogden"
mu = [0.04]
alpha = [5.7]
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "traction"
value = [0, 0, 0.01]
)";
  check_case_refused(ogden + "[fem]\nelement = \"q1\"\n", 18, "fem.element", {"q1_p0", "locks"});
  check_case_refused(ogden + "[fem]\nformulation = 'log_strain'\n", 18, "fem.formulation", {"hyperelastic"});
  check_case_refused(ogden + "[msm]\ndesign = 'linear_method'\n", 18, "msm.design",
                     {"Poisson's ratio below 0.5"});
  CHECK_NOTHROW(read_text(ogden + "[msm]\ndesign = 'linear_method'\npoissons_ratio = 0.35\n"));
  CHECK_NOTHROW(read_text(ogden + "[fem]\nelement = 'q1_bbar'\n"));
}

TEST_CASE(
    "what is left open in the finite elements needs an expectation that says how accurate they must be") {
  const std::string text =
      replaced(replaced(good_case, "refine = 1", "accuracy = 'auto'"), "'log_strain'", "'auto'");
  const Case c = read_text(text);
  CHECK(c.fem.has_auto_accuracy);
  CHECK(c.fem.has_auto_formulation);
  CHECK(c.fem.formulation == Formulation::log_strain);
  CHECK(c.fem.refine == 0);
  CHECK_THROWS_WITH(read_text(replaced(text, "error_percent", "msm")),
                    Catch::Contains("expect") && Catch::Contains("error_percent or fem"));
  const std::string linear = "model = 'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.35\n";
  CHECK_THROWS_WITH(read_text(replaced(text, linear, "model = 'ogden'\nmu = [1]\nalpha = [2]\n")),
                    Catch::Contains("fem.formulation") && Catch::Contains("hyperelastic"));
}

TEST_CASE("a mistake in [fem] is refused where it is made") {
  const std::string fem = "formulation = 'log_strain'\nelement = 'q1_bbar'\nrefine = 1\n";
  const auto refused = mistakes_in(good_case);
  refused("formulation = 'log_strain'", "formulation = 'log-strain'", 19, "fem.formulation",
          {"did you mean \"log_strain\"?"});
  refused("element = 'q1_bbar'", "element = 'q3'", 20, "fem.element", {"is \"q3\"", "q2_p1"});
  refused("element = 'q1_bbar'", "elment = 'q1_bbar'", 20, "fem.elment", {"did you mean \"element\"?"});
  refused("refine = 1", "refine = -1", 21, "fem.refine", {"is -1", "from 0 to 8"});
  refused("refine = 1", "refine = 1.0", 21, "fem.refine", {"is 1.0", "whole number"});
  refused("refine = 1", "refine = true", 21, "fem.refine", {"is true", "whole number"});
  refused("refine = 1", "refine = 8", 21, "fem.refine", {"is 8", "fewer"});
  refused(fem, "formulation = 'hyperelastic'\n", 19, "fem.formulation", {"ogden"});
  refused(fem, "formulation = 'saint_venant_kirchhoff'\nelement = 'q1_bbar'\n", 20, "fem.element",
          {"\"q1\" | \"q1_wilson\" | \"q2\""});
  refused(fem, "formulation = 'saint_venant_kirchhoff'\nelement = 'q2_p1'\n", 20, "fem.element",
          {"\"q1\" | \"q1_wilson\" | \"q2\""});
  refused("[fem]", "fem = 3\n[fim]", 18, "load[0].fem", {"is not a key here"});
  // it belongs to the load above
  // it
  // what is left open
  refused("formulation = 'log_strain'", "formulation = 'autom'", 19, "fem.formulation",
          {"is \"autom\"", "did you mean \"auto\"?"});
  refused("refine = 1", "accuracy = 'fine'", 21, "fem.accuracy", {"\"auto\"", "\"none\""});
  refused("refine = 1", "accept = ['inverted', 'inverted']", 21, "fem.accept[1]", {"not in the list yet"});
  refused("refine = 1", "accept = ['loose']", 21, "fem.accept[0]", {"\"inverted\"", "\"unstable\""});
}

TEST_CASE("a mistake in [msm] is refused where it is made") {
  const std::string msm = "design = 'moduli'\npoissons_ratio = 0.3\nsplit = 0.8\n";
  const auto refused = mistakes_in(good_case);
  refused("design = 'moduli'", "design = 'modulus'", 23, "msm.design",
          {"linear_method", "did you mean \"moduli\"?"});
  refused("poissons_ratio = 0.3\nsplit", "poissons_ratio = 0.7\nsplit", 24, "msm.poissons_ratio",
          {"is 0.7", "below 0.5"});
  refused("split = 0.8", "split = 1.2", 25, "msm.split", {"is 1.2", "from 0 to 1"});
  refused("design = 'moduli'", "design = 'linear_method'", 25, "msm.split",
          {"left out", "\"moduli\" | \"hybrid\""});
  refused("split = 0.8", "paths = ['uniaxial']", 25, "msm.paths", {"left out", "\"multi_load\""});
  refused("split = 0.8", "strain_range = [0, 0.1]", 25, "msm.strain_range",
          {"left out", "\"nonlinear_method\""});
  refused("design = 'moduli'", "design = 'multi_load'\npaths = ['uniaxal']", 24, "msm.paths[0]",
          {"did you mean \"uniaxial\"?"});
  refused("design = 'moduli'", "design = 'multi_load'\npaths = ['uniaxial', 'uniaxial']", 24, "msm.paths[1]",
          {"not in the list yet"});
  refused("design = 'moduli'", "design = 'multi_load'\npaths = ['uniaxial']\nweights = [1, 2]", 25,
          "msm.weights", {"is [1, 2]", "1 numbers"});
  refused("design = 'moduli'", "design = 'multi_load'\nweights = [0, 0, 0, 0]", 24, "msm.weights",
          {"not all 0"});
  refused("design = 'moduli'", "design = 'multi_load'\nstrain_range = [0.2, 0.1]", 24, "msm.strain_range",
          {"the smaller first"});
  refused("design = 'moduli'", "design = 'multi_load'\nvolume_term = 'fited'", 24, "msm.volume_term",
          {"did you mean \"fitted\"?"});
  refused("split = 0.8", "solver = 'newtn'", 25, "msm.solver", {"\"fire\"", "did you mean \"newton\"?"});
  refused("split = 0.8", "stiffness = [1, 2, 3]", 25, "msm.stiffness", {"left out", "\"given\""});
  refused("split = 0.8", "volume_stiffness = 0.1", 25, "msm.volume_stiffness", {"left out", "\"given\""});
  refused(msm, "design = 'given'\n", 22, "msm.stiffness", {"is missing", "k_e, k_f, k_d"});
  refused(msm, "design = 'given'\nstiffness = [1, 2]\n", 24, "msm.stiffness", {"is [1, 2]", "three numbers"});
  refused(msm, "design = 'given'\nstiffness = [1, -2, 3]\n", 24, "msm.stiffness", {"none below 0"});
  refused(msm, "design = 'given'\nstiffness = [0, 0, 0]\n", 24, "msm.stiffness", {"one is above 0"});
  refused(msm, "design = 'given'\nstiffness = [1, 2, 3]\nvolume_stiffness = -1\n", 25, "msm.volume_stiffness",
          {"is -1"});
  refused(msm, "design = 'given'\nstiffness = [1, 2, 3]\npoissons_ratio = 0.3\n", 25, "msm.poissons_ratio",
          {"left out"});
  refused(msm, "design = 'given'\naxis_stiffness = [1, 2, 3, 4, 5, 6]\n", 24, "msm.axis_stiffness",
          {"seven numbers"});
  refused(msm, "design = 'given'\naxis_stiffness = [1, 2, 3, 4, 5, 6, -7]\n", 24, "msm.axis_stiffness",
          {"none below 0"});
  refused(msm, "design = 'given'\naxis_stiffness = [1, 2, 3, 4, 5, 6, 7]\nstiffness = [1, 2, 3]\n", 25,
          "msm.stiffness", {"left out beside axis_stiffness"});
  refused(msm, "design = 'uniform'\nstiffness = [1, 2, 3]\n", 24, "msm.stiffness",
          {"above 0", "every spring"});
  refused(msm, "design = 'uniform'\nstiffness = 0\n", 24, "msm.stiffness", {"above 0"});
  refused(msm, "design = 'uniform'\nsplit = 0.5\n", 24, "msm.split", {"left out", "\"hybrid\""});
  refused(msm, "design = 'baudet'\npoissons_ratio = -0.3\n", 23, "msm.design",
          {"-0.25 and more", "\"baudet\""});
  refused(msm, "design = 'biquadratic'\nlaw = 'power_log'\n", 24, "msm.law", {"left out", "law of its own"});
  refused(msm, "design = 'midline'\nbeta = 0\n", 24, "msm.beta", {"above 0, at most 2"});
  refused(msm, "design = 'matched'\nbeta = 1\n", 24, "msm.beta", {"left out", "\"midline\""});
  refused(msm, "design = 'network'\n", 22, "msm.file", {"is missing"});
  refused(msm, "design = 'network'\nfile = 'springs.txt'\n", 24, "msm.file", {".csv"});
  refused(msm, "design = 'network'\nfile = 'no_such.csv'\n", 24, "msm.file", {"a file that exists"});
  refused(msm, "design = 'hybrid'\nfile = 'springs.csv'\n", 24, "msm.file", {"left out", "\"network\""});
  refused(msm, "design = 'lloyd'\npoissons_ratio = 0.3\n", 24, "msm.poissons_ratio",
          {"left out", "\"hybrid\""});
  refused(msm, "design = 'hybrid'\npoissons_ratio = -0.2\n", 23, "msm.design", {"0 and more", "-0.2"});
  refused(msm, "design = 'matched'\npoissons_ratio = -0.2\n", 23, "msm.design",
          {"0 and more", "\"matched\""});
  refused(msm, "design = 'matched'\nlaw = 'hooke'\n", 24, "msm.law", {"left out", "\"matched\""});
  refused(msm, "design = 'matched'\nexponent = -1\n", 24, "msm.exponent", {"left out", "\"matched\""});
  refused("split = 0.8", "law = 'power'", 25, "msm.law", {"\"hooke\"", "\"power_log\""});
  refused("split = 0.8", "law = 'power_log'", 22, "msm.exponent", {"is missing", "a number, or three"});
  refused("split = 0.8", "exponent = -1.5", 25, "msm.exponent", {"left out", "law = \"power_log\""});
  refused("split = 0.8", "law = 'hooke'\nexponent = 1", 26, "msm.exponent",
          {"left out", "law = \"power_log\""});
  refused("split = 0.8", "law = 'power_log'\nexponent = nan", 26, "msm.exponent",
          {"is nan", "from -20 to 20"});
  refused("split = 0.8", "law = 'power_log'\nexponent = [1, 2]", 26, "msm.exponent", {"is [1, 2]", "three"});
  refused("split = 0.8", "law = 'power_log'\nexponent = [1, 2, 21]", 26, "msm.exponent", {"from -20 to 20"});
  refused("design = 'moduli'\npoissons_ratio = 0.3\nsplit = 0.8",
          "design = 'nonlinear_method'\nlaw = 'power_log'\nexponent = -1", 24, "msm.law",
          {"\"hooke\" with design = \"nonlinear_method\""});
}

TEST_CASE("an exponent is one number for all springs or one for each kind") {
  const auto read = [](const std::string& lines) {
    return read_case_text(replaced(good_case, "split = 0.8", lines), "case.toml").msm;
  };
  CHECK(law_of(read("split = 0.8"), soft) == SpringLaw::hooke);
  CHECK_FALSE(read("split = 0.8").exponent);
  CHECK(read("law = 'power_log'\nexponent = -1.5").law == SpringLaw::power_log);
  CHECK(read("law = 'power_log'\nexponent = -1.5").exponent == std::array{-1.5, -1.5, -1.5});
  CHECK(read("law = 'power_log'\nexponent = [-1.3, -2, 2]").exponent == std::array{-1.3, -2., 2.});
}

TEST_CASE("the multi-load design has exponents of the file, or fits them, and Hooke's springs by default") {
  const auto read = [](const std::string& lines) {
    return read_case_text(replaced(good_case, "design = 'moduli'", "design = 'multi_load'\n" + lines),
                          "case.toml")
        .msm;
  };
  CHECK(law_of(read(""), soft) == SpringLaw::hooke);
  CHECK(read("law = 'power_log'").law == SpringLaw::power_log);
  CHECK_FALSE(read("law = 'power_log'").exponent);
  CHECK(read("law = 'power_log'\nexponent = 2").exponent == std::array{2., 2., 2.});
}

TEST_CASE("the matched design has power-log springs, whose exponents the file leaves to it") {
  const Msm msm = read_case_text(replaced(good_case, "design = 'moduli'",
                                          "design = 'matched'\nstrain_range = [-0.1, 0.3]"),
                                 "case.toml")
                      .msm;
  CHECK(msm.design == Design::matched);
  CHECK(law_of(msm, soft) == SpringLaw::power_log);
  CHECK_FALSE(msm.exponent);
  CHECK(msm.strain_range == std::array{-0.1, 0.3});
}

TEST_CASE(
    "the midline design has power-log springs, but in a material with a fibre, or Hooke's by the file") {
  const auto read = [](const std::string& lines) {
    return read_case_text(replaced(good_case, "design = 'moduli'", "design = 'midline'\n" + lines),
                          "case.toml")
        .msm;
  };
  CHECK(law_of(read(""), soft) == SpringLaw::power_log);
  CHECK(law_of(read(""), fibrous) == SpringLaw::hooke);
  Msm without_ratio;
  without_ratio.design = Design::midline;
  CHECK(law_of(without_ratio, LinearElastic{0.3, 0.2}) == SpringLaw::hooke); // a negative volume term
  CHECK(law_of(read("law = 'power_log'"), LinearElastic{0.3, 0.2}) == SpringLaw::power_log);
  CHECK(law_of(read("law = 'hooke'"), soft) == SpringLaw::hooke);
  CHECK_FALSE(read("").beta);
  CHECK(read("beta = 0.8").beta == 0.8);
  CHECK_FALSE(read("law = 'power_log'").exponent);
  CHECK(read("exponent = -1").exponent == std::array{-1., -1., -1.});
}

TEST_CASE(
    "midlines are Hooke's in materials of several exponents, and under forces on nodes above nu = 0.35") {
  const auto law = [](const std::vector<Material>& materials, bool has_nodal_forces) {
    Msm msm;
    msm.design = Design::midline;
    settle_law(msm, materials, has_nodal_forces);
    return law_of(msm, materials.front());
  };
  const LinearElastic at_most{0.3, 0.35}, above{0.3, 0.4};
  for (const bool has_nodal_forces : {false, true}) {
    CHECK(law({at_most}, has_nodal_forces) == SpringLaw::power_log);
    CHECK(law({at_most, above}, has_nodal_forces) == SpringLaw::hooke);
    CHECK(law({above}, has_nodal_forces) == (has_nodal_forces ? SpringLaw::hooke : SpringLaw::power_log));
    CHECK(law({soft}, has_nodal_forces) == SpringLaw::power_log);
  }
  CHECK(law({LinearElastic{1, 0.4}, LinearElastic{2, 0.4}}, false) == SpringLaw::power_log);
  Msm asked;
  asked.design = Design::midline;
  asked.law = SpringLaw::power_log;
  settle_law(asked, {above}, true);
  CHECK(asked.law == SpringLaw::power_log);
}

TEST_CASE("stiffnesses are of kinds of springs, of kinds along every axis, or of all springs") {
  const auto read = [](const std::string& lines) {
    const std::string msm = "design = 'moduli'\npoissons_ratio = 0.3\nsplit = 0.8\n";
    return read_case_text(replaced(good_case, msm, lines), "case.toml").msm;
  };
  CHECK(read("design = 'given'\nstiffness = [1, 2, 3]\n").stiffness == std::array{1., 2., 3.});
  const Msm by_axis = read("design = 'given'\naxis_stiffness = [1, 2, 3, 4, 5, 6, 7]\n");
  CHECK_FALSE(by_axis.stiffness);
  CHECK(by_axis.axis_stiffness == std::array{1., 2., 3., 4., 5., 6., 7.});
  CHECK(read("design = 'uniform'\nstiffness = 45\n").uniform_stiffness == 45);
  CHECK_FALSE(read("design = 'uniform'\n").uniform_stiffness);
}

TEST_CASE("numbers of iterations belong to force scaling") {
  const auto with = [](const std::string& keys) {
    return replaced(good_case, "design = 'moduli'", "design = 'moduli'\n" + keys);
  };
  const Case c =
      read_text(with("solver = 'force_scaling'\nrelaxation_steps = 10\nrelaxation_iterations = 30\n"
                     "further_iterations = 2000"));
  REQUIRE(c.msm.relaxation);
  CHECK(c.msm.relaxation->all() == 2300);
  CHECK_FALSE(read_text(with("solver = 'force_scaling'")).msm.relaxation);
  const auto refused = [&](const std::string& keys, const std::string& reason) {
    CHECK_THROWS_WITH(read_text(with(keys)), Catch::Contains(reason));
  };
  refused("solver = 'fire'\nfurther_iterations = 5", "belongs to solver = \"force_scaling\"");
  refused("solver = 'force_scaling'\nrelaxation_steps = 10", "is 0, must be from 1 to 1000000");
  refused("solver = 'force_scaling'\nrelaxation_steps = 1000\nrelaxation_iterations = 1001",
          "is 1001000, must be");
  refused("solver = 'force_scaling'\nrelaxation_steps = 0\nrelaxation_iterations = 1", "from 1 to 1000");
}
