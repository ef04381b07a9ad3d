#include "msm/design/matched.hpp"

#include "cases/case/error.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/ogden.hpp"
#include "mechanics/laws/principal_stress.hpp"
#include "msm/design/design.hpp"
#include "msm/design/homogeneous.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

namespace {

/// c of a test: (N(1 + e) + N(1 - e)) / (2 E e²), N the nominal stress of a stretch. What follows c is e²
/// times the fourth-order coefficient, which is below 100 here; N's rounding, 1e-14, adds 1e-6.
template<class NominalStress>
double coefficient_of(const NominalStress& nominal_stress, double youngs_modulus) {
  const double e = 3e-4;
  return (nominal_stress(1 + e) + nominal_stress(1 - e)) / (2 * youngs_modulus * e * e);
}
constexpr double difference_error = 3e-5;

template<class Law>
double nominal_stress(const typename Law::Material& material, double stretch) {
  const auto parameters = mechanics::parameters_of(material);
  const auto cauchy = [&](double lateral) -> Eigen::Vector3d {
    const Eigen::Vector3d x(lateral, lateral, std::log(stretch));
    const double j = std::exp(x.sum());
    return (mechanics::kirchhoff_stress<Law>(parameters, x) / j).array() +
           Law::pressure(j - 1, parameters).value;
  };
  double low = -0.1, high = 0.1; // logarithmic strains of the sides
  while (high - low > 1e-17) {
    const double middle = (low + high) / 2;
    if (middle == low || middle == high) break;
    (cauchy(middle)(0) < 0 ? low : high) = middle;
  }
  return cauchy(low)(2) * std::exp(2 * low);
}

mechanics::ElasticModuli moduli_of(double mu, double poissons_ratio) {
  return mechanics::elastic_moduli(cases::LinearElastic{2 * mu * (1 + poissons_ratio), poissons_ratio});
}

msm::DesignRequest matched(const cases::Material& material, double edge = 1) {
  msm::DesignRequest request;
  request.options.design = cases::Design::matched;
  request.material = material;
  request.cell = msm::cube(edge);
  return request;
}

} // namespace

TEST_CASE("the second-order coefficient is the one of the material's own law", "[verification]") {
  const double nu = GENERATE(0.1, 0.3, 0.45);
  const cases::LinearElastic linear{0.3, nu};
  CHECK(msm::second_order_coefficient(linear, nu) ==
        Approx(coefficient_of([&](double l) { return nominal_stress<mechanics::LogStrain>(linear, l); }, 0.3))
            .epsilon(difference_error));
  cases::Ogden two_terms{{0.03, -0.01}, {1.7, -6}, std::nullopt};
  const double mu = mechanics::shear_modulus(two_terms);
  two_terms.bulk_modulus = moduli_of(mu, nu).kappa;
  CHECK(msm::second_order_coefficient(two_terms, nu) ==
        Approx(coefficient_of([&](double l) { return nominal_stress<mechanics::Ogden>(two_terms, l); },
                              2 * mu * (1 + nu)))
            .margin(difference_error));
}

TEST_CASE("a lattice with the closed form's exponent has the material's second-order coefficient",
          "[verification]") {
  const double nu = GENERATE(0.25, 0.35, 0.49), t = GENERATE(0., 0.5, 0.8, 1.), c = GENERATE(-1.4, 0.7);
  const mechanics::ElasticModuli moduli = moduli_of(0.12, nu);
  msm::CellStiffness springs =
      msm::design([&] {
        msm::DesignRequest request = matched(cases::LinearElastic{0.24 * (1 + nu), nu});
        request.options.design = cases::Design::hybrid;
        request.options.split = t;
        return request;
      }())
          .stiffness;
  const double p = msm::closed_form_exponent(c, moduli, t);
  springs.exponents = msm::Exponents{p, p, p};
  const auto stress = [&](double stretch) {
    const double lateral = msm::free_lateral_stretch(springs, 1, stretch);
    return msm::lattice_stress(springs, 1, Eigen::Vector3d(lateral, lateral, stretch).asDiagonal())(2, 2);
  };
  CHECK(coefficient_of(stress, 0.24 * (1 + nu)) == Approx(c).epsilon(difference_error));
}

TEST_CASE("the closed form gives the exponents that an independent root search found", "[verification]") {
  const double printed = 6e-4; // three decimals
  for (const auto& [nu, p] :
       {std::pair(0.25, -1.380), {0.3, -1.443}, {0.35, -1.485}, {0.45, -1.522}, {0.49, -1.528}}) {
    const double c = msm::second_order_coefficient(cases::LinearElastic{1, nu}, nu);
    CHECK(msm::closed_form_exponent(c, moduli_of(1, nu), 0.8) == Approx(p).margin(printed));
  }
  const mechanics::ElasticModuli incompressible{200, 1, 200 + 2. / 3};
  const double nu = 200. / 402;
  for (const auto& [alpha, p] : {std::pair(5.7255, 1.788), {2., -0.378}, {10., 4.273}}) {
    const double c = msm::second_order_coefficient(cases::Ogden{{1}, {alpha}, std::nullopt}, nu);
    CHECK(msm::closed_form_exponent(c, incompressible, 0.8) == Approx(p).margin(printed));
  }
}

TEST_CASE("over a vanishing range of strains the matched exponents are the closed form's") {
  const cases::LinearElastic material{0.3, 0.35};
  const mechanics::ElasticModuli moduli = mechanics::elastic_moduli(material);
  const double p = msm::closed_form_exponent(msm::second_order_coefficient(material, 0.35), moduli, 0.8);
  const auto [edge, face, internal, law] = msm::matched_exponents(material, moduli, 0.8, {-1e-4, 1e-4}).exponents;
  // their share of the stresses is the strain, 1e-4: squared, over the prior's square
  for (const double exponent : {edge, face, internal}) CHECK(exponent == Approx(p).margin(1e-3));
}

TEST_CASE("the matched exponents are those of an independent least squares", "[verification]") {
  struct Row {
    double nu, edge, face, internal;
  };
  // numpy: principal stretches, analytic derivatives, Gauss-Newton to 1e-6
  for (const Row& row : {Row{0.25, -1.17508, -1.85027, -2.00992}, Row{0.35, -1.26919, -1.87148, -1.93085},
                         Row{0.49, -1.50165, -2.21570, -1.90016}}) {
    const auto exponents = msm::design(matched(cases::LinearElastic{0.3, row.nu})).stiffness.exponents;
    REQUIRE(exponents);
    CHECK(exponents->edge == Approx(row.edge).margin(1e-4));
    CHECK(exponents->face_diagonal == Approx(row.face).margin(1e-4));
    CHECK(exponents->internal_diagonal == Approx(row.internal).margin(1e-4));
  }
}

TEST_CASE("a matched design has the hybrid's stiffnesses, and exponents of neither E nor the cell's edge") {
  msm::DesignRequest hybrid = matched(bodies::thesis_ogden);
  hybrid.options.design = cases::Design::hybrid;
  hybrid.options.split = 0.8;
  const msm::CellStiffness springs = msm::design(matched(bodies::thesis_ogden)).stiffness,
                           of_hybrid = msm::design(hybrid).stiffness;
  CHECK(springs.edge == of_hybrid.edge);
  CHECK(springs.face_diagonal == of_hybrid.face_diagonal);
  CHECK(springs.internal_diagonal == of_hybrid.internal_diagonal);
  CHECK(springs.volume == of_hybrid.volume);
  cases::Ogden stiff = bodies::thesis_ogden;
  for (double& mu : stiff.mu) mu *= 100;
  const msm::CellStiffness others = msm::design(matched(stiff, 2.5)).stiffness;
  CHECK(others.exponents->edge == Approx(springs.exponents->edge).margin(1e-6));
  CHECK(others.exponents->face_diagonal == Approx(springs.exponents->face_diagonal).margin(1e-6));
  CHECK(others.exponents->internal_diagonal == Approx(springs.exponents->internal_diagonal).margin(1e-6));
}

TEST_CASE("springs of a soft Ogden material keep the tension that it keeps at large stretches") {
  const cases::Ogden softening{{0.03, 0.013}, {2, -2}, std::nullopt};
  const auto [edge, face, internal, law] = *msm::design(matched(softening)).stiffness.exponents;
  for (const double exponent : {edge, face, internal})
    CHECK(exponent >= msm::lowest_ogden_exponent - 1e-12); // Ceres projects
  CHECK(edge == Approx(msm::lowest_ogden_exponent));       // unbounded: about -1.1
}

TEST_CASE("a matched lattice that is unstable within its range of strains is warned of") {
  msm::DesignRequest request = matched(cases::LinearElastic{0.3, 0.49});
  request.options.strain_range = {-0.1, 0.1};
  CHECK(msm::design(request).warnings.empty());
  request.options.strain_range = {-0.1, 0.25}; // design prints a limit of about 1.18
  const auto warnings = msm::design(request).warnings;
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings.front(), Catch::Contains("not stable over the logarithmic strains from -0.1 to 0.25"));
}

TEST_CASE("a matched design refuses a Poisson's ratio below 0") {
  CHECK_THROWS_AS(msm::design(matched(cases::LinearElastic{0.3, -0.01})), cases::InputError);
  CHECK(msm::design(matched(cases::LinearElastic{0.3, 0})).stiffness.exponents);
}
