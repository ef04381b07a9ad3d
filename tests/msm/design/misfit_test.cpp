#include "msm/design/cell_at_rest.hpp"

#include "msm/design/design.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

/// What a lattice's small-strain moduli are off from its material's.
namespace {

msm::DesignResult designed(const cases::Material& material, cases::Design design,
                           double poissons_ratio = -1) {
  msm::DesignRequest request;
  request.material = material;
  request.options.design = design;
  if (poissons_ratio >= 0) request.options.poissons_ratio = poissons_ratio;
  return msm::design(request);
}

bool says_so(const msm::DesignResult& result) {
  return std::count(result.warnings.begin(), result.warnings.end(), result.misfit->text) == 1;
}

} // namespace

TEST_CASE("the misfit of moduli is the largest of E, G and nu by axis", "[verification]") {
  const msm::Elasticity material = *msm::elasticity_at_rest(cases::LinearElastic{0.3, 0.35});
  CHECK(msm::moduli_misfit(material, material).largest < 1e-12); // round-off of an inverse
  const double twice = 1, round_off = 1e-12;
  CHECK(msm::moduli_misfit(2 * material, material).largest == Approx(twice).epsilon(round_off));
  CHECK(msm::moduli_misfit(*msm::elasticity_at_rest(cases::LinearElastic{0.3, 0.25}), material).largest ==
        Approx(0.1).epsilon(round_off)); // of nu; G errs by 8 %
  msm::Elasticity softer = material;
  softer(4, 4) *= 0.7; // xz alone
  const msm::ModuliMisfit misfit = msm::moduli_misfit(softer, material);
  CHECK(misfit.largest == Approx(0.3).epsilon(round_off));
  CHECK_THAT(misfit.text, Catch::Contains("E 0.3 MPa, nu 0.35, G (0.111, 0.0778, 0.111) MPa along its axes"));
}

TEST_CASE("a lattice with a strain that costs nothing, and one that is not a number, miss every modulus") {
  const msm::Elasticity material = *msm::elasticity_at_rest(cases::LinearElastic{0.3, 0.35});
  msm::Elasticity floppy = material;
  floppy(3, 3) = 0;
  CHECK(std::isinf(msm::moduli_misfit(floppy, material).largest));
  floppy(3, 3) = std::nan("");
  CHECK_FALSE(msm::moduli_misfit(floppy, material).largest <= msm::told_moduli_misfit);
}

TEST_CASE("designs whose lattice misses the material's moduli say so, the others do not") {
  const cases::LinearElastic tissue{0.005, 0.47};
  using D = cases::Design;
  for (const D design : {D::hybrid, D::matched, D::biquadratic}) {
    const msm::DesignResult result = designed(tissue, design);
    CHECK(result.misfit->largest < 1e-9); // closed forms
    CHECK_FALSE(says_so(result));
  }
  for (const D design : {D::moduli, D::ladd_kinney, D::baudet, D::uniform, D::van_gelder, D::lloyd}) {
    CAPTURE(cases::name_of(design));
    CHECK(says_so(designed(tissue, design)));
  }
  // As published, the thesis's springs alone have E along the axes and nu = 1/4 at nu = 1/4.
  CHECK(designed({cases::LinearElastic{0.005, 0.25}}, D::ladd_kinney).misfit->largest < 1e-9);
  CHECK(says_so(designed(tissue, D::hybrid, 0.35))); // designed from another ratio than the material's
}

TEST_CASE("a fibre along any axis has its elasticity there", "[verification]") {
  cases::TransverselyIsotropic muscle{0.06, 0.02, 0.45, 0.7, 0.012, Eigen::Vector3d::UnitY()};
  const msm::Elasticity compliance = msm::elasticity_at_rest(muscle)->inverse();
  CHECK(1 / compliance(1, 1) == Approx(0.06));
  CHECK(1 / compliance(2, 2) == Approx(0.02));
  CHECK(1 / compliance(3, 3) == Approx(0.012));            // yz
  CHECK(1 / compliance(4, 4) == Approx(0.02 / (2 * 1.7))); // xz, across the fibre
  CHECK(-compliance(0, 1) / compliance(1, 1) == Approx(0.45));
  muscle.fibre = Eigen::Vector3d(1, 1, 0).normalized();
  CHECK_FALSE(msm::elasticity_at_rest(muscle));
}
