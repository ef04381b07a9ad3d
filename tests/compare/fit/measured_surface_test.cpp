#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"
#include "compare/measure/surfaces.hpp"
#include "tests/support/fitted_bar.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <random>

using namespace springproof;
using namespace compare;

namespace {

/// The deformed surface of finer elements with the true moduli, as a file .obj.
/// @param deviation  of every vertex and component, mm
std::string scan(const std::string& file, double deviation) {
  const cases::Scene scene = cases::make_scene(cases::read_case(
      file, {"body.cells=[6,6,6]", fmt::format("material.youngs_modulus={}", fitted_bar::true_modulus),
             fmt::format("material.poissons_ratio={}", fitted_bar::true_ratio)}));
  const mechanics::EmbeddedSurface surface = embedded_surface(scene);
  std::vector<Eigen::Vector3d> deformed;
  mechanics::move(surface, solve_fem(scene, 0).fem.solution.displacement, deformed);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, deviation);
  std::string text;
  for (const Eigen::Vector3d& x : deformed)
    text += fmt::format("v {} {} {}\n", x.x() + noise(random), x.y() + noise(random), x.z() + noise(random));
  for (const auto& t : surface.rest.triangles)
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

} // namespace

TEST_CASE("the surface of a finer body tells the moduli, to the noise of its points", "[verification]") {
  const TemporaryFolder folder;
  const FitCases cases{{folder.write("bar.toml", fitted_bar::text)}, {}, {}};
  constexpr double deviation = 0.002; // mm; the ends move by 0.16, the sides by 0.07
  folder.write("scan.obj", scan(cases.files[0], deviation));
  const std::string data = folder.write("data.csv", fmt::format("surface,sigma\nscan.obj,{}\n", deviation));
  const FitData read = read_fit_data("surface,sigma\nscan.obj,0.002\n", data, cases);
  REQUIRE(read.states.size() == 1);
  const MeasuredSurface& surface = read.states[0].surface.value();
  CHECK(surface.moved.maxCoeff() == Approx(0.161).margin(5 * deviation));  // out along z: T/E times 10 mm
  CHECK(surface.moved.minCoeff() == Approx(-0.066).margin(5 * deviation)); // in along x and y
  const Fit fit = fit_cases(cases, read, "data.csv", {}, cases::Side::fem, fitted_bar::answer);
  INFO(fit.found.failure);
  REQUIRE(fit.found.has_values());
  CHECK(fit.n_data == surface.points.size());
  const double truth[] = {fitted_bar::true_modulus, fitted_bar::true_ratio};
  for (Eigen::Index p = 0; p < 2; ++p) {
    CHECK(fit.found.lower[p] < truth[p]);
    CHECK(fit.found.upper[p] > truth[p]);
    CHECK(fit.found.upper[p] - fit.found.lower[p] < 0.02 * truth[p]);
  }
  REQUIRE(fit.measures.size() == 1);
  CHECK(fit.measures[0].error_percent.value() ==
        Approx(100 * deviation / 0.09).epsilon(0.3)); // relative to the motion
  CHECK_FALSE(fit.held_out.error_percent); // what is left of a scan would tell what is held out of it
  CHECK(fit.held_out.reason == "one surface; name cases with --hold-out");
}

TEST_CASE(
    "a file of data without a readable surface, or with two of one state, is refused where it says so") {
  const TemporaryFolder folder;
  const FitCases cases{{folder.write("bar.toml", fitted_bar::text)}, {}, {}};
  const auto read = [&](const std::string& text) {
    return read_fit_data(text, (folder.path / "data.csv").string(), cases);
  };
  CHECK_THROWS_WITH(read("surface\nnone.stl\n"),
                    Catch::Contains("data.csv:2") && Catch::Contains("none.stl"));
  folder.write("tiny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  CHECK_THROWS_WITH(read("surface\ntiny.obj\ntiny.obj\n"),
                    Catch::Contains("data.csv:3") && Catch::Contains("already"));
}
