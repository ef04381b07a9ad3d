#include "msm/design/multi_load.hpp"

#include "cases/case/error.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/principal_stress.hpp"
#include "mechanics/laws/yeoh.hpp"
#include "msm/design/cells.hpp"
#include "msm/design/design.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/closed_forms.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

namespace {

using cases::LoadPath;

const std::vector<LoadPath> all_paths = {LoadPath::uniaxial, LoadPath::equibiaxial, LoadPath::pure_shear,
                                         LoadPath::simple_shear};

msm::MultiLoadSettings settings(double lowest, double highest, bool has_volume_term) {
  return {all_paths, {1, 1, 1, 1}, lowest, highest, has_volume_term, 8};
}

} // namespace

TEST_CASE("a small linear elastic fit with a volume term is isotropic with the material's moduli",
          "[verification]") {
  const double nu = GENERATE(0.25, 0.35, 0.45);
  const msm::MultiLoadFit fit =
      msm::multi_load_method(cases::LinearElastic{0.3, nu}, 1.2, settings(-1e-4, 1e-4, true));
  const msm::LatticeModuli moduli = closed::lattice_moduli(fit.stiffness, 1.2);
  const double tolerance = 2e-3; // strains of 1e-4, amplified by lambda/mu up to 9
  CHECK(moduli.youngs_modulus == Approx(0.3).epsilon(tolerance));
  CHECK(moduli.poissons_ratio == Approx(nu).epsilon(tolerance));
  CHECK(moduli.zener == Approx(1).epsilon(tolerance));
}

TEST_CASE("the reference material's free direction carries no stress", "[verification]") {
  for (const cases::Material& material :
       {cases::Material(bodies::thesis_ogden), cases::Material(cases::LinearElastic{0.3, 0.35})}) {
    for (const double strain : {-0.1, 0.2}) {
      const double round_off = 1e-14;
      CHECK(std::abs(msm::material_state(material, LoadPath::uniaxial, strain).cauchy_stress(1, 1)) <=
            round_off);
      CHECK(std::abs(msm::material_state(material, LoadPath::equibiaxial, strain).cauchy_stress(2, 2)) <=
            round_off);
      CHECK(std::abs(msm::material_state(material, LoadPath::pure_shear, strain).cauchy_stress(2, 2)) <=
            round_off);
    }
  }
}

TEST_CASE("the Ogden reference has the thesis's uniaxial curve and keeps its volume", "[verification]") {
  const msm::MaterialState state = msm::material_state(bodies::thesis_ogden, LoadPath::uniaxial, 0.3);
  const double stretch = std::exp(0.3);
  const double expected = 3 * 0.005044 * (std::pow(stretch, 5.7255) - std::pow(stretch, -5.7255 / 2));
  CHECK(state.cauchy_stress(2, 2) == Approx(expected).epsilon(1e-4)); // 0.01444 was rounded to four digits
  CHECK(state.deformation_gradient.determinant() == Approx(1).epsilon(1e-14)); // exponentials of a zero sum
}

TEST_CASE("no neighbouring stiffness set fits better") {
  const msm::MultiLoadSettings wide = settings(-0.2, 0.4, true);
  const msm::MultiLoadFit fit = msm::multi_load_method(bodies::thesis_ogden, 1, wide);
  double sum = 0;
  for (std::size_t p = 0; p < all_paths.size(); ++p) sum += wide.weights[p] * fit.errors[p] * fit.errors[p];
  CHECK(fit.objective == Approx(sum).epsilon(1e-14));                              // its definition
  CHECK(closed::lattice_moduli(fit.stiffness, 1).c12 == Approx(8).epsilon(1e-12)); // lambda as asked for
  // Dropping three of four paths can only fit the remaining one better.
  for (std::size_t p = 0; p < all_paths.size(); ++p) {
    msm::MultiLoadSettings alone = wide;
    alone.weights = {0, 0, 0, 0};
    alone.weights[p] = 1;
    CHECK(msm::multi_load_method(bodies::thesis_ogden, 1, alone).errors[p] <=
          fit.errors[p] * (1 + 1e-9)); // solver's tolerance
  }
}

TEST_CASE("stiffnesses scale with the edge and the volume term does not", "[verification]") {
  const msm::CellStiffness one =
      msm::multi_load_method(bodies::thesis_ogden, 1, settings(-0.1, 0.3, true)).stiffness;
  const msm::CellStiffness two =
      msm::multi_load_method(bodies::thesis_ogden, 2, settings(-0.1, 0.3, true)).stiffness;
  const double tolerance = 1e-6; // the solver's parameter tolerance, times the problem's condition
  CHECK(two.edge == Approx(2 * one.edge).epsilon(tolerance));
  CHECK(two.internal_diagonal == Approx(2 * one.internal_diagonal).epsilon(tolerance));
  CHECK(two.volume == Approx(one.volume).epsilon(tolerance));
}

TEST_CASE("a fit without a volume term has none, and no negative spring") {
  const msm::MultiLoadFit fit = msm::multi_load_method(bodies::thesis_ogden, 1, settings(-0.2, 0.4, false));
  CHECK(fit.stiffness.volume == 0);
  for (const double k : fit.stiffness.springs()) CHECK(k >= 0);
}

TEST_CASE("a split that is given is kept") {
  msm::MultiLoadSettings held = settings(-0.1, 0.3, true);
  held.split = 0.6;
  const msm::CellStiffness k = msm::multi_load_method(bodies::thesis_ogden, 1, held).stiffness;
  const double internal = 4 * k.internal_diagonal / 3, face = 2 * k.face_diagonal;
  CHECK(internal / (internal + face) == Approx(0.6).epsilon(1e-12)); // two products
}

TEST_CASE("exponents that are fitted leave a smaller objective than Hooke's springs and than one exponent") {
  for (const cases::Material& material :
       {cases::Material(bodies::thesis_ogden), cases::Material(cases::LinearElastic{0.3, 0.35})}) {
    const double exponent = std::holds_alternative<cases::Ogden>(material) ? 1.8 : -1.5;
    msm::MultiLoadSettings wide = settings(-0.2, 0.2, true);
    wide.split = 0.8;
    const msm::MultiLoadFit fitted = msm::multi_load_with_exponents(material, 1, wide, exponent),
                            hooke = msm::multi_load_method(material, 1, wide);
    wide.exponents = msm::Exponents{exponent, exponent, exponent};
    const msm::MultiLoadFit held = msm::multi_load_method(material, 1, wide);
    CHECK(fitted.objective < hooke.objective);
    CHECK(held.objective < hooke.objective);
    REQUIRE(fitted.stiffness.exponents);
    // Its stiffnesses are the best of springs of its exponents: no smaller minimum is left.
    wide.exponents = fitted.stiffness.exponents;
    CHECK(msm::multi_load_method(material, 1, wide).objective ==
          Approx(fitted.objective).epsilon(1e-6)); // the solver's tolerance
    CHECK(msm::is_stable_over({-0.2, 0.2}, fitted.stiffness, 1));
  }
}

TEST_CASE("under small strains a fit with exponents has the material's moduli too", "[verification]") {
  msm::DesignRequest request;
  request.options.design = cases::Design::multi_load;
  request.options.law = cases::SpringLaw::power_log;
  request.options.strain_range = {{-1e-3, 1e-3}};
  request.material = cases::LinearElastic{0.3, 0.3};
  const msm::DesignResult result = msm::design(request);
  CHECK(result.moduli.youngs_modulus == Approx(0.3).epsilon(2e-3)); // strains of 1e-3
  CHECK(result.moduli.zener == Approx(1).epsilon(2e-3));
  REQUIRE(result.stiffness.exponents);
  CHECK(result.warnings.empty());
  CHECK_THROWS_AS(msm::multi_load_with_exponents(request.material, 1, settings(0.1, -0.1, true), -1.5),
                  cases::InputError);
}

TEST_CASE("multi-load settings without a meaning are refused") {
  msm::MultiLoadSettings broken = settings(-0.1, 0.1, true);
  SECTION("no paths") {
    broken.paths.clear();
  }
  SECTION("weights that are not one per path") {
    broken.weights.pop_back();
  }
  SECTION("a negative weight") {
    broken.weights[0] = -1;
  }
  SECTION("weights that are all zero") {
    broken.weights = {0, 0, 0, 0};
  }
  SECTION("a split above 1") {
    broken.split = 1.5;
  }
  SECTION("an empty strain range") {
    broken.highest_strain = broken.lowest_strain;
  }
  CHECK_THROWS_AS(msm::multi_load_method(bodies::thesis_ogden, 1, broken), cases::InputError);
}

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
  const double mu = cases::at_rest(two_terms).shear_modulus;
  two_terms.bulk_modulus = moduli_of(mu, nu).kappa;
  CHECK(msm::second_order_coefficient(two_terms, nu) ==
        Approx(coefficient_of([&](double l) { return nominal_stress<mechanics::Ogden>(two_terms, l); },
                              2 * mu * (1 + nu)))
            .margin(difference_error));
  const cases::Yeoh yeoh{mu / 2, 0.1, -0.05, two_terms.bulk_modulus};
  CHECK(msm::second_order_coefficient(yeoh, nu) ==
        Approx(coefficient_of([&](double l) { return nominal_stress<mechanics::Yeoh>(yeoh, l); },
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
  const msm::Exponents fitted = msm::matched_exponents(material, moduli, 0.8, {-1e-4, 1e-4}).exponents;
  // their share of the stresses is the strain, 1e-4: squared, over the prior's square
  for (const double exponent : fitted.by_kind) CHECK(exponent == Approx(p).margin(1e-3));
}

TEST_CASE("the matched exponents are those of an independent least squares", "[verification]") {
  struct Row {
    double nu;
    std::array<double, 3> by_kind;
  };
  // numpy: principal stretches, analytic derivatives, Gauss-Newton to 1e-6
  for (const Row& row : {Row{0.25, {-1.17508, -1.85027, -2.00992}}, Row{0.35, {-1.26919, -1.87148, -1.93085}},
                         Row{0.49, {-1.50165, -2.21570, -1.90016}}}) {
    const auto exponents = msm::design(matched(cases::LinearElastic{0.3, row.nu})).stiffness.exponents;
    REQUIRE(exponents);
    for (std::size_t kind = 0; kind < 3; ++kind)
      CHECK(exponents->by_kind[kind] == Approx(row.by_kind[kind]).margin(1e-4));
  }
}

TEST_CASE("a matched design has the hybrid's stiffnesses, and exponents of neither E nor the cell's edge") {
  msm::DesignRequest hybrid = matched(bodies::thesis_ogden);
  hybrid.options.design = cases::Design::hybrid;
  hybrid.options.split = 0.8;
  const msm::CellStiffness springs = msm::design(matched(bodies::thesis_ogden)).stiffness,
                           of_hybrid = msm::design(hybrid).stiffness;
  CHECK(springs.springs() == of_hybrid.springs());
  CHECK(springs.volume == of_hybrid.volume);
  cases::Ogden stiff = bodies::thesis_ogden;
  for (double& mu : stiff.mu) mu *= 100;
  const msm::CellStiffness others = msm::design(matched(stiff, 2.5)).stiffness;
  for (std::size_t kind = 0; kind < 3; ++kind)
    CHECK(others.exponents->by_kind[kind] == Approx(springs.exponents->by_kind[kind]).margin(1e-6));
}

TEST_CASE("springs of a soft Ogden material keep the tension that it keeps at large stretches") {
  const cases::Ogden softening{{0.03, 0.013}, {2, -2}, std::nullopt};
  const msm::Exponents kept = *msm::design(matched(softening)).stiffness.exponents;
  for (const double exponent : kept.by_kind)
    CHECK(exponent >= msm::lowest_ogden_exponent - 1e-12);      // Ceres projects
  CHECK(kept.by_kind[0] == Approx(msm::lowest_ogden_exponent)); // unbounded: about -1.1
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
