#include "msm/design/multi_load.hpp"

#include "cases/case/error.hpp"
#include "msm/design/cell_at_rest.hpp"
#include "msm/design/design.hpp"
#include "msm/design/homogeneous.hpp"
#include "tests/support/bodies.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

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
  const msm::LatticeModuli moduli = msm::lattice_moduli(fit.stiffness, 1.2);
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
  CHECK(fit.objective == Approx(sum).epsilon(1e-14));                           // its definition
  CHECK(msm::lattice_moduli(fit.stiffness, 1).c12 == Approx(8).epsilon(1e-12)); // lambda as asked for
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
  CHECK(fit.stiffness.edge >= 0);
  CHECK(fit.stiffness.face_diagonal >= 0);
  CHECK(fit.stiffness.internal_diagonal >= 0);
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
