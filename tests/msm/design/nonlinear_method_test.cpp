#include "msm/design/uniaxial.hpp"

#include "cases/case/error.hpp"
#include "msm/spring_body.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

using namespace springproof;

namespace {

const msm::CellStiffness published = {0.014, 0.017, 0.063, 0}; // thesis eq. 5.12, in N/mm

msm::UniaxialCurve ogden_reference() {
  return msm::sample(msm::ogden_law(bodies::thesis_ogden), 0.5, {0, 0.4});
}

msm::UniaxialCurve linear_reference(double poissons_ratio) {
  return msm::sample([](double stretch) { return 0.3 * std::log(stretch); }, poissons_ratio, {0, 0.1});
}

} // namespace

TEST_CASE("the published Ogden set has phi = 6.94e-3 and the true minimum is 3.80e-3", "[verification]") {
  const msm::UniaxialCurve reference = ogden_reference();
  CHECK(msm::uniaxial_objective(published, 1, reference) ==
        Approx(6.94e-3).margin(0.005e-3)); // last digit given
  const msm::NonlinearFit fit = msm::nonlinear_method(reference, 1);
  CHECK(fit.objective == Approx(3.80e-3).margin(0.005e-3)); // last digit given
}

TEST_CASE("every start finds the same minimiser") {
  for (const msm::UniaxialCurve& reference :
       {ogden_reference(), linear_reference(0.5), linear_reference(0.35)}) {
    const msm::NonlinearFit fit = msm::nonlinear_method(reference, 1);
    REQUIRE(fit.minimisers.size() == 6);
    // 1e-10 on the objective's decrease leaves the square root of it, times the valley's condition, on the
    // stiffness.
    const double tolerance =
        1e-4 * (fit.stiffness.edge + fit.stiffness.face_diagonal + fit.stiffness.internal_diagonal);
    for (const msm::CellStiffness& found : fit.minimisers) {
      CHECK(found.edge == Approx(fit.stiffness.edge).margin(tolerance));
      CHECK(found.face_diagonal == Approx(fit.stiffness.face_diagonal).margin(tolerance));
      CHECK(found.internal_diagonal == Approx(fit.stiffness.internal_diagonal).margin(tolerance));
    }
  }
}

TEST_CASE("the minimiser returns the springs whose own curve is the reference", "[verification]") {
  const msm::CellStiffness truth = {0.02, 0.03, 0.05, 0};
  const std::vector<double> strains = ogden_reference().axial_strain;
  const msm::NonlinearFit fit = msm::nonlinear_method(msm::uniaxial_response(truth, 1.5, strains), 1.5);
  CHECK(fit.objective <= 1e-16); // the square of residuals near 1e-8, at which the decrease stalls
  CHECK(fit.stiffness.edge ==
        Approx(truth.edge).epsilon(1e-4)); // valley: sensitivity ~1e3 times the residual
  CHECK(fit.stiffness.face_diagonal == Approx(truth.face_diagonal).epsilon(1e-4));
  CHECK(fit.stiffness.internal_diagonal == Approx(truth.internal_diagonal).epsilon(1e-4));
}

TEST_CASE("the residuals' derivatives agree with finite differences", "[verification]") {
  const msm::UniaxialCurve reference = ogden_reference();
  Eigen::MatrixX3d jacobian;
  msm::uniaxial_residuals(published, 1, reference, &jacobian);
  double msm::CellStiffness::*const members[] = {
      &msm::CellStiffness::edge, &msm::CellStiffness::face_diagonal, &msm::CellStiffness::internal_diagonal};
  for (int c = 0; c < 3; ++c) {
    const double h = 1e-6;
    msm::CellStiffness above = published, below = published;
    above.*members[c] += h;
    below.*members[c] -= h;
    const Eigen::VectorXd difference =
        (msm::uniaxial_residuals(above, 1, reference) - msm::uniaxial_residuals(below, 1, reference)) /
        (2 * h);
    // Central difference: h² times a third derivative of order (1/k)³ relative to the first.
    CHECK((jacobian.col(c) - difference).norm() <= 1e-6 * jacobian.norm());
  }
}

TEST_CASE("equations 5.3 and 5.4 are the equilibrium of the cell of springs", "[verification]") {
  const double edge = 1.3, strain = 0.25;
  const msm::UniaxialCurve curve = msm::uniaxial_response(published, edge, {strain});
  const double z = edge * std::exp(strain), x = edge * std::exp(curve.lateral_strain[0]);
  const cases::Mesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(edge), {1, 1, 1});
  const msm::Lattice lattice = msm::make_lattice(mesh, {published});
  msm::Points positions = lattice.rest;
  for (Eigen::Vector3d& p : positions) p = p.cwiseProduct(Eigen::Vector3d(x, x, z)) / edge;
  const msm::Points force = msm::internal_force(lattice, positions);
  const double applied = curve.stress[0] * x * x / 4;
  for (std::size_t p = 0; p < 8; ++p) {
    const double expected = lattice.rest[p].z() > 0 ? -applied : applied;
    CHECK((force[p] - Eigen::Vector3d(0, 0, expected)).norm() <=
          1e-12 * applied); // round-off of seven springs
  }
}

TEST_CASE("a Yeoh law of one coefficient is the neo-Hookean one with mu = 2 C1", "[verification]") {
  const msm::StressLaw yeoh = msm::yeoh_law({0.02});
  const msm::StressLaw neo_hookean = msm::ogden_law({{0.04}, {2}, std::nullopt});
  for (const double stretch : {0.8, 1.0, 1.3})
    CHECK(yeoh(stretch) == Approx(neo_hookean(stretch)).margin(1e-16)); // round-off
}

TEST_CASE("uniaxial curves have the initial slope 3 mu when incompressible", "[verification]") {
  const double h = 1e-5;
  const double slope = (msm::ogden_law(bodies::thesis_ogden)(std::exp(h)) -
                        msm::ogden_law(bodies::thesis_ogden)(std::exp(-h))) /
                       (2 * h);
  CHECK(slope == Approx(3 * 0.04332).epsilon(1e-8)); // difference: h² times (alpha²)
}

TEST_CASE("the uniaxial test identifies three stiffnesses badly") {
  const msm::UniaxialCurve reference = ogden_reference();
  const msm::Identifiability found = msm::identifiability(published, 1, reference);
  CHECK(found.condition > 20);
  CHECK(found.singular_values(0) >= found.singular_values(1));
  CHECK((found.directions.transpose() * found.directions - Eigen::Matrix3d::Identity()).norm() <=
        1e-12); // round-off
}

TEST_CASE("a measured curve is read with and without lateral strains") {
  const msm::UniaxialCurve two = msm::read_curve("strain,stress\n0,0\n0.1,0.02\n", "curve.csv");
  CHECK(two.lateral_strain[1] == -0.05);
  const msm::UniaxialCurve three = msm::read_curve("# lab 3\n0.0 0.0 0.0\n0.1 0.02 -0.03\n", "curve.csv");
  CHECK(three.lateral_strain[1] == -0.03);
}

// A raw curve of a test bench in kPa and engineering strain was taken for MPa and logarithmic strain. Looked
// for the same kind: every other file of numbers that is read; displacements, springs, pulls and recordings
// have one unit each in their headings or pages.
TEST_CASE("a measured curve in any kind of strain and stress and in any unit is the same curve") {
  const msm::UniaxialCurve expected = msm::read_curve("-0.1 -0.02 0.04\n0.1 0.03 -0.04\n", "curve.csv");
  for (const auto strain :
       {msm::CurveStrain::engineering, msm::CurveStrain::logarithmic, msm::CurveStrain::stretch})
    for (const auto stress : {msm::CurveStress::nominal, msm::CurveStress::cauchy})
      for (const auto unit : {msm::CurveUnit::Pa, msm::CurveUnit::kPa, msm::CurveUnit::MPa}) {
        CAPTURE(cases::name_of(strain), cases::name_of(stress), cases::name_of(unit));
        const auto written = [&](double value) {
          return strain == msm::CurveStrain::engineering ? std::exp(value) - 1
                 : strain == msm::CurveStrain::stretch   ? std::exp(value)
                                                         : value;
        };
        const double per_mpa = unit == msm::CurveUnit::Pa ? 1e6 : unit == msm::CurveUnit::kPa ? 1e3 : 1;
        std::string text;
        for (std::size_t i = 0; i < 2; ++i) {
          const double area = std::exp(2 * expected.lateral_strain[i]); // relative to that at rest
          const double force = expected.stress[i] * (stress == msm::CurveStress::nominal ? area : 1);
          text += fmt::format("{:.17g},{:.17g},{:.17g}\n", written(expected.axial_strain[i]), per_mpa * force,
                              written(expected.lateral_strain[i]));
        }
        const msm::UniaxialCurve found = msm::read_curve(text, "curve.csv", {strain, stress, unit});
        for (std::size_t i = 0; i < 2; ++i) { // rounding of exp and log
          CHECK(found.axial_strain[i] == Approx(expected.axial_strain[i]).epsilon(1e-13));
          CHECK(found.stress[i] == Approx(expected.stress[i]).epsilon(1e-13));
          CHECK(found.lateral_strain[i] == Approx(expected.lateral_strain[i]).epsilon(1e-13));
        }
      }
  msm::CurveColumns columns{msm::CurveStrain::engineering, msm::CurveStress::nominal, msm::CurveUnit::kPa,
                            0.3};
  CHECK(msm::read_curve("0.1 1\n0.2 2\n", "curve.csv", columns).lateral_strain[0] ==
        Approx(-0.3 * std::log(1.1)).epsilon(1e-13));
  for (const std::string text : {"0 0\n10 1\n", "-1 0\n0 1\n", "-1.5 0\n0 1\n", "0 0 0\n0.1 1 -1\n"}) {
    columns.poissons_ratio.reset();
    CHECK_THROWS_WITH(msm::read_curve(text, "curve.csv", columns),
                      Catch::Contains("curve.csv:") && Catch::Contains("as engineering strain is"));
  }
}

TEST_CASE("a broken measured curve is refused with its line") {
  const auto [text, message] = GENERATE(table<std::string, std::string>({
      {"", "two strains"},
      {"strain,stress\n", "two strains"},
      {"0,0\n0.1,0.02\n0.1,0.03\n", "curve.csv:3: the strains must increase"},
      {"0,0\n0.2,0.02\n0.1,0.03\n", "curve.csv:3: the strains must increase"},
      {"0,0\n0.1,nan\n", "curve.csv:2"},
      {"0,0\n0.1\n", "curve.csv:2: 1 columns"},
      {"0,0\n0.1,0.2x\n", "curve.csv:2"},
      {"0,0\n0.1,0.2,1e400\n", "curve.csv:2: \"1e400\""},
      {"0,0\n0.1,0.2\nx0.2,0.3\n0.3,0.4\n", "curve.csv:3: \"x0.2\""},
      {"strain,stress\n0,0\nstrain,stress\n0.1,0.2\n", "curve.csv:3: \"strain\""},
      {"0,0\n0.1,0\n", "every stress is zero"},
      {"0,0,0\n0.1,1,0\n", "every lateral strain is zero"},
  }));
  try {
    msm::read_curve(text, "curve.csv");
    FAIL("accepted: " << text);
  } catch (const cases::InputError& error) {
    CHECK_THAT(error.what(), Catch::Contains(message));
  }
}

TEST_CASE("a reference without lateral strain is refused, for the objective divides by it") {
  CHECK_THROWS_AS(msm::nonlinear_method(linear_reference(0), 1), cases::InputError);
}

TEST_CASE("a curve that ends without stress is fitted") {
  msm::UniaxialCurve reference = linear_reference(0.35);
  reference.stress.back() = 0; // a line that was cut
  const msm::NonlinearFit fit = msm::nonlinear_method(reference, 1);
  CHECK(fit.objective > 0);
  CHECK(fit.objective < 1); // that of no springs at all is 2
}
