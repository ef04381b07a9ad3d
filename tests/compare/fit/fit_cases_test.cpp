#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "tests/support/case_text.hpp"
#include "tests/support/fitted_bar.hpp"

#include <catch2/catch.hpp>
#include <iomanip>
#include <random>
#include <sstream>

using namespace springproof;
using namespace compare;

namespace {

const std::string bar = fitted_bar::text + R"(msm = { design = "hybrid" }
measure = [{ name = "length", kind = "displacement", node = "near 0 0 10", component = "z" },
           { name = "volume", kind = "volume" },
           { name = "everywhere", kind = "displacement_field_l2" }]
)";

/// A clamped block that bends under its load.
const std::string block = R"(schema = 1
name = "block"
body = { shape = "box", size = [4, 4, 12], cells = [1, 1, 3] }
material = { model = "linear_elastic", youngs_modulus = 0.3, poissons_ratio = 0.3 }
fixed = [{ region = "z-" }]
load = [{ region = "z+", kind = "traction", value = [1e-4, 0, 0] }]
msm = { design = "hybrid" }
measure = [{ name = "drop", kind = "displacement", node = "near 0 0 12", component = "x" }]
)";

using fitted_bar::answer;
using fitted_bar::true_modulus;
using fitted_bar::true_ratio;

/// Markers on three lines through the body as their displacements are, to a part of each.
template<class Random>
std::string markers(double part, Random& random) {
  std::normal_distribution<double> noise(0, 1);
  std::ostringstream text;
  text << std::setprecision(17) << "x,y,z,ux,uy,uz,ux sigma,uy sigma,uz sigma\n";
  for (int i = 1; i <= 20; ++i) {
    const double at = i / 2., strain = 0.01 / true_modulus, along = strain * at, across = -true_ratio * along;
    const auto measured = [&](double value) { return value * (1 + part * noise(random)); };
    const double sigma = std::max(part, 1e-6); // where there is no noise, too
    text << at << ',' << at << ',' << at << ',' << measured(across) << ',' << measured(across) << ','
         << measured(along) << ',' << sigma * std::abs(across) << ',' << sigma * std::abs(across) << ','
         << sigma * along << '\n';
  }
  return text.str();
}

Fit fit_bar(const FitCases& cases, const std::string& data, cases::Side side = cases::Side::fem,
            const std::vector<std::string>& free = {}) {
  return fit_cases(cases, read_fit_data(data, "data.csv", cases), "data.csv", free, side, answer);
}

} // namespace

TEST_CASE("markers of a bar have its Young's modulus and Poisson's ratio", "[verification]") {
  const TemporaryFolder folder;
  std::mt19937 random(1);
  const FitCases cases{{folder.write("bar.toml", bar)}, {}, {}};
  const std::string data = markers(0, random);
  const Fit fem = fit_bar(cases, data);
  REQUIRE(fem.found.has_values());
  CHECK(fem.found.parameters[0] == Approx(true_modulus).epsilon(1e-6)); // the bar is exact; 1e-7 of the fit
  CHECK(fem.found.parameters[1] == Approx(true_ratio).epsilon(1e-6));
  CHECK(fem.n_data == 60);
  CHECK(fem.held_out.error_percent.value() < 1e-3);
  const std::string key = "material.youngs_modulus=";
  REQUIRE(fem.settings.at(0).rfind(key, 0) == 0);
  CHECK(std::stod(fem.settings.at(0).substr(key.size())) == Approx(true_modulus).epsilon(1e-6));
  const Fit springs = fit_bar(cases, data, cases::Side::msm);
  REQUIRE(springs.found.has_values());
  CHECK(springs.found.parameters[0] == Approx(true_modulus).epsilon(0.05)); // strains of 1.6 % are not small
  CHECK(springs.found.parameters[1] == Approx(true_ratio).epsilon(0.05));
}

TEST_CASE("drops of a block do not tell Poisson's ratio beside Young's modulus") {
  const TemporaryFolder folder;
  const FitCases cases{{folder.write("block.toml", block)}, {}, {}};
  const std::string data = "load[0].value[0],drop,sigma\n1e-4,0.32,0.003\n2e-4,0.64,0.006\n3e-4,0.96,0.009\n";
  const Fit both = fit_bar(cases, data, cases::Side::msm);
  REQUIRE(both.found.undetermined.size() == 1);
  CHECK_THAT(both.found.undetermined[0], Catch::Contains("poissons_ratio"));
  CHECK(both.settings.empty());
  const Fit one = fit_bar(cases, data, cases::Side::msm, {"material.youngs_modulus=0.5"});
  REQUIRE(one.found.has_values());
  CHECK(one.held_out.how == "3-fold");
  std::ostringstream text;
  write_fit_text(text, both);
  CHECK_THAT(text.str(), Catch::Contains("undetermined") && Catch::Contains("No value is given"));
}

TEST_CASE("a fit solves the case's own mesh alone, whatever accuracy the case asks for") {
  const TemporaryFolder folder;
  const FitCases cases{{folder.write("block.toml", block)}, {}, {}};
  CHECK(cases::read_case(cases.files[0]).fem.has_auto_accuracy);
  const auto checked = [](const std::vector<Question>& questions) {
    for (const Question& question : questions) CHECK_FALSE(question.scene.definition.fem.has_auto_accuracy);
    return answer(questions);
  };
  const std::string rows = "drop,sigma\n0.32,0.01\n";
  const Fit fit = fit_cases(cases, read_fit_data(rows, "data.csv", cases), "data.csv",
                            {"material.youngs_modulus"}, cases::Side::fem, checked);
  CHECK(fit.found.has_values());
}

TEST_CASE("data of a case that is held out are predicted, not fitted") {
  const TemporaryFolder folder;
  const std::string other = case_text::replaced(block, "\"block\"", "\"other\"");
  const FitCases cases{{folder.write("block.toml", block)}, {folder.write("other.toml", other)}, {}};
  const std::string rows = "case,load[0].value[0],drop\nblock,1e-4,0.32\nblock,2e-4,0.63\nother,3e-4,";
  const Fit good = fit_bar(cases, rows + "0.95\n", cases::Side::msm, {"material.youngs_modulus"});
  const Fit bad = fit_bar(cases, rows + "1.9\n", cases::Side::msm, {"material.youngs_modulus"});
  REQUIRE(good.found.has_values());
  CHECK(good.found.parameters[0] == bad.found.parameters[0]);
  CHECK(good.held_out.how == "named");
  REQUIRE(good.held_out.error_percent);
  REQUIRE(bad.held_out.error_percent);
  CHECK(*good.held_out.error_percent < 3);
  CHECK(*bad.held_out.error_percent > 40);
  CHECK(good.rows.at(2).is_held_out);
}

TEST_CASE("springs come nearer to refined finite elements by a fit, and other loads show by how much") {
  const TemporaryFolder folder;
  const std::string pulled = case_text::replaced(case_text::replaced(block, "\"block\"", "\"pulled\""),
                                                 "[1e-4, 0, 0]", "[0, 0, 1e-3]");
  const FitCases cases{{folder.write("block.toml", block)}, {folder.write("pulled.toml", pulled)}, {}};
  const FitData data = limits_as_data(cases, answer);
  const Fit fit = fit_cases(cases, data, "limit", {"material.youngs_modulus"}, cases::Side::msm, answer);
  REQUIRE(fit.found.has_values());
  CHECK(fit.rows.empty());
  REQUIRE(fit.measures.size() == 2);
  CHECK(fit.measures[0].error_percent.value() <
        30); // coarse cells bend too little; a fit of E mends most of it
  REQUIRE(fit.held_out.start_error_percent);
}

TEST_CASE("springs fitted to one load beat the hybrid design under another, on four bodies of five",
          "[long]") {
  const std::string folder = SPRINGPROOF_SOURCE_DIR "/cases/fit/";
  int n_nearer = 0;
  for (const auto& [fitted, held_out] : {std::pair("cube_sheared", "cube_pulled"),
                                         {"bridge_pressed", "bridge_sagging"},
                                         {"beam_bent", "beam_pushed"},
                                         {"wall_pushed", "wall_sheared"},
                                         {"pad_sheared", "pad_pressed"}}) {
    CAPTURE(fitted);
    const auto with = [&, &one = fitted, &other = held_out](const std::vector<std::string>& settings) {
      const FitCases cases{{folder + one + ".toml"}, {folder + other + ".toml"}, settings};
      const Fit fit = fit_cases(cases, limits_as_data(cases, answer), "limit", {"material.youngs_modulus"},
                                cases::Side::msm, answer);
      REQUIRE(fit.found.has_values());
      return fit.held_out;
    };
    const double found = with({}).error_percent.value(),
                 hybrid = with({"msm.design=hybrid"}).start_error_percent.value();
    CHECK(found < 8);
    n_nearer += found < hybrid;
  }
  CHECK(n_nearer == 4); // all but the pad, which is nearly incompressible
}

TEST_CASE("one law of springs has brain cortex's measured forces to 5 % over the curve", "[long]") {
  const std::string study = SPRINGPROOF_SOURCE_DIR "/cases/studies/palpated_cortex/",
                    data = study + "pulled.csv";
  const FitCases cases{{study + "springs.toml"}, {}, {}};
  const Fit fit =
      fit_cases(cases, read_fit_data(cases::read_text_file(data), data, cases), data,
                {"msm.stiffness[0]", "msm.stiffness[1]", "msm.exponent[0]"}, cases::Side::msm, answer);
  REQUIRE(fit.found.has_values());
  CHECK(fit.n_data == 32);
  CHECK(fit.measures.at(0).error_percent.value() < 5); // the norm of the differences over the data's
  REQUIRE(fit.rows.size() == 32);
  const double largest = std::abs(fit.rows.front().value); // N, where it is pressed furthest
  for (const auto& row : fit.rows)                         // small ones are further off in their own percent
    CHECK(std::abs(row.fitted.value() - row.value) < 0.05 * largest);
}

TEST_CASE("a field is held out as a whole, and one alone not at all") {
  const TemporaryFolder folder;
  const FitCases cases{{folder.write("bar.toml", bar)}, {}, {}};
  const auto state = [&](double factor) {
    FitState one{cases.files[0], {"load[0].value[2]=" + std::to_string(0.01 * factor)}, false};
    const cases::Scene scene = scene_of(cases, one);
    for (const Eigen::Vector3d& x : scene.mesh.nodes)
      one.field.push_back(factor * 0.01 / true_modulus *
                          Eigen::Vector3d(-true_ratio, -true_ratio, 1).cwiseProduct(x));
    return one;
  };
  const auto fitted = [&](const FitData& data) {
    return fit_cases(cases, data, "limit", {"material.youngs_modulus"}, cases::Side::fem, answer);
  };
  const Fit one = fitted({{state(1)}, {}});
  REQUIRE(one.found.has_values());
  const Json json = fits_to_json({one})["fits"][0]["held_out"];
  for (const char* key : {"how", "error_percent", "start_error_percent", "factor"})
    CHECK(json[key].is_null());
  CHECK(json["reason"] == "one field; name cases with --hold-out");
  std::ostringstream text;
  write_fit_text(text, one);
  CHECK_THAT(text.str(), Catch::Contains("nothing held out: one field; name cases with --hold-out"));

  // The second field is twice as soft as the first: each tells another modulus, and errs by half of the other
  // field or by as much as it. A single component left out would be told by the rest of its own field.
  FitState soft = state(1);
  soft.settings = {"load[0].value[2]=0.02"};
  for (Eigen::Vector3d& u : soft.field) u *= 4;
  const Fit two = fitted({{state(1), soft}, {}});
  REQUIRE(two.found.has_values());
  CHECK(two.held_out.how == "2-fold");
  CHECK(two.held_out.error_percent.value() > 50);
}

TEST_CASE("what cannot be fitted is refused with what to do") {
  const TemporaryFolder folder;
  const FitCases cases{{folder.write("bar.toml", bar)}, {}, {}};
  const auto refused = [&](const std::string& data, const std::vector<std::string>& free,
                           const std::string& says) {
    CHECK_THROWS_WITH(fit_bar(cases, data, cases::Side::msm, free), Catch::Contains(says));
  };
  refused("length\n0.1\n", {}, "data.csv: has 1 data to be fitted, must have at least as many for 2");
  refused("length\n0.1\n", {"material.youngs_modulus"}, "standard deviations in a column sigma");
  refused("length,sigma\n0.1,0.1\n", {"material.mu[0]"}, "say where to start: --free material.mu[0]=START");
  refused("length,sigma\n0.1,0.1\n", {"material.youngs_modulus=soft"}, "must be a finite number");
  refused("length,sigma\n0.1,0.1\n", {"material.young=1"}, "material.young: is not a key here");
  refused("body.cells,length,sigma\n0,0.1,0.1\n", {"material.youngs_modulus"}, "body.cells");
}
