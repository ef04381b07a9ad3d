#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "compare/fit/fit.hpp"

#include <catch2/catch.hpp>

using namespace springproof;
using namespace compare;

namespace {

msm::UniaxialCurve from_law(const msm::StressLaw& law) {
  return msm::sample(law, 0.5, {-0.3, 0.4, 15});
}

double value(const Fit& fit, std::size_t i) {
  REQUIRE(fit.found.has_values());
  return fit.found.parameters[static_cast<Eigen::Index>(i)];
}

} // namespace

TEST_CASE("every law's parameters are found from its own curve", "[verification]") {
  // to the tolerance of the minimisation, 1e-7 of a parameter
  const Fit neo_hookean =
      fit_curve(from_law(msm::ogden_law({{0.02}, {2}, {}})), CurveLaw::neo_hookean, 1, "curve");
  CHECK(value(neo_hookean, 0) == Approx(0.02).epsilon(1e-6));
  const Fit mooney =
      fit_curve(from_law(msm::ogden_law({{0.02, 0.01}, {2, -2}, {}})), CurveLaw::mooney_rivlin, 1, "curve");
  CHECK(value(mooney, 0) == Approx(0.01).epsilon(1e-6));
  CHECK(value(mooney, 1) == Approx(0.005).epsilon(1e-6));
  const Fit yeoh = fit_curve(from_law(msm::yeoh_law({0.01, 0.003, 0.001})), CurveLaw::yeoh, 3, "curve");
  CHECK(value(yeoh, 0) == Approx(0.01).epsilon(1e-6));
  CHECK(value(yeoh, 2) == Approx(0.001).epsilon(1e-5));
  CHECK_THAT(
      yeoh.settings.at(0),
      Catch::Matches(R"(material=\{model="yeoh", c10=0\.0[01][0-9]*, c20=0\.00[0-9]*, c30=0\.0[0-9]*\})"));
  const Fit ogden = fit_curve(from_law(msm::ogden_law({{0.02}, {-14}, {}})), CurveLaw::ogden, 1, "curve");
  CHECK(value(ogden, 0) == Approx(0.02).epsilon(1e-6));
  CHECK(value(ogden, 1) == Approx(-14).epsilon(1e-6));
  CHECK(ogden.settings.at(0) == "material={model=\"ogden\", mu=[0.02], alpha=[-14]}");
}

TEST_CASE("brain's curve has the parameters that another program's least squares find", "[verification]") {
  const std::string file = SPRINGPROOF_SOURCE_DIR "/cases/studies/palpated_cortex/measured.csv";
  const msm::UniaxialCurve curve =
      msm::read_curve(cases::read_text_file(file), file,
                      {msm::CurveStrain::stretch, msm::CurveStress::nominal, msm::CurveUnit::kPa, {}});
  const Fit fit = fit_curve(curve, CurveLaw::ogden, 1, file);
  // gnuplot's, of the same sum of squares, has four digits: fit.gp beside the curve
  CHECK(value(fit, 0) == Approx(1.546e-3).epsilon(5e-4));
  CHECK(value(fit, 1) == Approx(-17.52).epsilon(5e-4));
  CHECK(fit.found.lower[1] < -17.52);
  CHECK(fit.found.upper[1] > -17.52);
  REQUIRE(fit.held_out.error_percent);
  CHECK(*fit.held_out.error_percent >= fit.measures.at(0).error_percent.value());
}

TEST_CASE("a curve at one strain and its opposite tells no three coefficients of Yeoh") {
  msm::UniaxialCurve curve;
  for (const double strain : {-1.02e-3, -1.01e-3, -1e-3, 1e-3, 1.01e-3, 1.02e-3}) {
    curve.axial_strain.push_back(strain);
    curve.stress.push_back(0.03 * strain * (1 + 0.01 * std::sin(1e6 * strain)));
    curve.lateral_strain.push_back(-strain / 2);
  }
  const Fit fit = fit_curve(curve, CurveLaw::yeoh, 3, "curve");
  CHECK_FALSE(fit.found.undetermined.empty());
  CHECK(fit.settings.empty());
}

TEST_CASE("a curve of no more strains than a law has parameters is refused") {
  msm::UniaxialCurve curve{{0, 0.1, 0.2}, {0, 0.01, 0.03}, {0, -0.05, -0.1}};
  CHECK_THROWS_WITH(fit_curve(curve, CurveLaw::ogden, 1, "short.csv"),
                    Catch::Contains("short.csv: has 2 strains") && Catch::Contains("more than the 2"));
}
