
#include "compare/cube/write_design.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/screen.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using Catch::Contains;
using compare::DesignAttempt;

namespace {

/// A design that was measured: errors of alpha_1 under small and large loads, percent.
DesignAttempt attempted(const std::string& name, double small, double large, bool is_stable,
                        double compression) {
  DesignAttempt attempt{name, msm::DesignResult{}};
  attempt.stability = msm::StabilityRange{3, compression, 1};
  const auto errors = [](const std::string& test, double error, bool stable) {
    return compare::LoadSetErrors{error, error, 0.5, stable, {{test, "alpha_1", -error, ""}}};
  };
  attempt.cube = compare::CubeErrors{errors("small", small, true), errors("large", large, is_stable)};
  return attempt;
}

DesignAttempt refusing(const std::string& name) {
  return {name, std::nullopt, "it refuses " + std::string(60, 'x') + " " + std::string(60, 'y')};
}

msm::DesignRequest request_of(double poissons_ratio) {
  return compare::design_request(cases::LinearElastic{0.3, poissons_ratio}, msm::cube(1), cases::Msm{});
}

} // namespace

TEST_CASE("the stable design with the smallest worst error is recommended, with its error, place and rival") {
  const std::string text = compare::recommendation_text(
      {attempted("moduli", 2, 9, true, 0.8), refusing("baudet"), attempted("matched", 1, 2.5, true, 0.7),
       attempted("uniform", 0.1, 0.2, false, 0.8)},
      request_of(0.3));
  CHECK_THAT(text, Catch::StartsWith("Use matched for E = 0.3 MPa and nu = 0.3:"));
  CHECK_THAT(text, Contains("2.50 % (alpha_1 under large loads)"));
  CHECK_THAT(text, Contains("the 2 designs that are stable in every test; the next is moduli with 9.00 %"));
  CHECK_THAT(text, Contains("A case that names no design takes it too."));
}

TEST_CASE(
    "another design that a case takes without a name is told with its error, and with what speaks for it") {
  const std::vector<DesignAttempt> attempts{attempted("hybrid", 3, 12, true, 0.5),
                                            attempted("matched", 1, 2, true, 0.8)};
  CHECK_THAT(compare::recommendation_text(attempts, request_of(0.45)),
             Contains("Use matched") && Contains("A case that names no design takes hybrid, with 12.00 %") &&
                 Contains("stable to logarithmic strains of 0.69, that of matched to 0.22"));
  CHECK_THAT(compare::recommendation_text({attempts[1]}, request_of(0.45)),
             Contains("A case that names no design takes hybrid."));
}

TEST_CASE("without a stable design none is recommended") {
  CHECK(compare::recommended({attempted("hybrid", 1, 1, false, 0.5), refusing("baudet")}) == nullptr);
  CHECK_THAT(compare::recommendation_text({attempted("hybrid", 1, 1, false, 0.5)}, request_of(0.45)),
             Catch::StartsWith("None is recommended"));
}

TEST_CASE(
    "the comparison of designs stands in 100 characters, refusals and warnings too, and shouts nowhere") {
  std::vector<DesignAttempt> attempts{attempted("nonlinear_method", 123.4, 1234.5, false, 0.8),
                                      refusing("baudet")};
  attempts[0].design->warnings = {"the lattice " + std::string(40, 'y') + " " + std::string(60, 'z')};
  attempts[0].design->stiffness.exponents = msm::Exponents{-12.345, 1.2345, 1.2345};
  attempts[0].cube->large.failure = "large shear: springs: no equilibrium " + std::string(100, '.');
  std::ostringstream out;
  write_comparison_text(out, attempts);
  INFO(out.str());
  CHECK(width_of_text(out.str()) <= 100);
  CHECK_THAT(out.str(), Contains("refused: it refuses") && Contains("springs: no equilibrium..."));
  CHECK_FALSE(has_shouting(out.str(), {}));
}
