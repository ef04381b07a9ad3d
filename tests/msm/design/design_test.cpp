#include "msm/design/design.hpp"

#include "cases/case/error.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace {

msm::DesignRequest given(std::array<double, 3> stiffness) {
  msm::DesignRequest request;
  request.material = cases::LinearElastic{0.3, 0.35};
  request.options.design = cases::Design::given;
  request.options.stiffness = stiffness;
  return request;
}

bool warns(const msm::DesignResult& result, const std::string& word) {
  for (const std::string& warning : result.warnings)
    if (warning.find(word) != std::string::npos) return true;
  return false;
}

} // namespace

TEST_CASE("given stiffnesses are N/m and become N/mm") {
  const msm::DesignResult result = msm::design(given({31, 47, 33}));
  CHECK(result.stiffness.edge == Approx(0.031).epsilon(1e-15)); // one multiplication
  CHECK(result.stiffness.internal_diagonal == Approx(0.033).epsilon(1e-15));
  CHECK(result.warnings == std::vector<std::string>{result.misfit->text}); // springs alone have no nu = 0.35
}

TEST_CASE("a design without diagonals is reported as a mechanism") {
  CHECK(warns(msm::design(given({31, 0, 0})), "mechanism"));
}

TEST_CASE("a negative stiffness is reported, and an indefinite tangent too") {
  const msm::DesignResult result = msm::design(given({31, 47, -200}));
  CHECK(warns(result, "negative"));
  CHECK(warns(result, "indefinite"));
}

TEST_CASE("a stiffness that is no number is reported") {
  CHECK(warns(msm::design(given({31, std::nan(""), 33})), "not a finite number"));
}

TEST_CASE("the linear method refuses materials for which it has no meaning") {
  msm::DesignRequest request;
  request.options.design = cases::Design::linear_method;
  request.element_stiffness = [](const cases::LinearElastic&) { return msm::CellMatrix::Identity(); };
  const auto material =
      GENERATE(cases::LinearElastic{0.3, 0.5}, cases::LinearElastic{0.3, -0.1}, cases::LinearElastic{0, 0.3},
               cases::LinearElastic{-1, 0.3}, cases::LinearElastic{std::nan(""), 0.3},
               cases::LinearElastic{0.3, std::nan("")});
  request.material = material;
  CHECK_THROWS_AS(msm::design(request), cases::InputError);
}

TEST_CASE("an incompressible material can be designed from another Poisson's ratio") {
  msm::DesignRequest request;
  request.material = cases::Ogden{{0.1, 0.2}, {2, -2}, std::nullopt};
  request.options.design = cases::Design::linear_method;
  request.options.poissons_ratio = 0.35;
  cases::LinearElastic asked{};
  request.element_stiffness = [&](const cases::LinearElastic& material) {
    asked = material;
    return msm::CellMatrix::Identity();
  };
  msm::design(request);
  CHECK(asked.youngs_modulus == Approx(0.9).epsilon(1e-15)); // E = 3 mu, mu = 0.1 + 0.2
  CHECK(asked.poissons_ratio == 0.35);
}

TEST_CASE("a finite bulk modulus gives Young's modulus 9 kappa mu / (3 kappa + mu)") {
  const cases::LinearElastic material = msm::small_strain_material(cases::Ogden{{1}, {2}, 2.0});
  CHECK(material.youngs_modulus == Approx(18.0 / 7).epsilon(1e-15)); // rational arithmetic
  CHECK(material.poissons_ratio == Approx(2.0 / 7).epsilon(1e-15));
}

TEST_CASE("the nonlinear method has its material's reference curve") {
  msm::DesignRequest request;
  request.material = cases::Ogden{{0.04332}, {5.7255}, std::nullopt};
  request.options.design = cases::Design::nonlinear_method;
  const msm::DesignResult result = msm::design(request);
  REQUIRE(result.residual);
  // Three equal terms are one with the sum of their moduli: the thesis's Ogden reference.
  CHECK(*result.residual == Approx(3.80e-3).margin(0.005e-3)); // last digit given
  CHECK(msm::uniaxial_reference(request).axial_strain.size() == 20);
}
