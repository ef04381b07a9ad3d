#include "msm/design/cells.hpp"

#include "msm/design/design.hpp"
#include "msm/tangent.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

namespace {

// Energy of a block of cells under two affine displacements, e_a : C : e_b, from the assembled tangent at
// rest. Each cell adds its own share to shared springs, so n^3 cells have n^3 times a cell's energy: no
// boundary correction.
double modulus(const msm::CellStiffness& stiffness, double edge, const Eigen::Matrix3d& a,
               const Eigen::Matrix3d& b) {
  const int n = 4;
  const cases::Mesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(n * edge), {n, n, n});
  const msm::Lattice lattice = msm::make_lattice(mesh, {stiffness});
  const auto u = [&](const Eigen::Matrix3d& e, int p) -> Eigen::Vector3d {
    return e * lattice.rest[static_cast<std::size_t>(p)];
  };
  double energy = 0;
  msm::visit_tangent_blocks(lattice, lattice.rest, msm::Clamp::no,
                            [&](int row, int column, const Eigen::Matrix3d& block) {
                              energy += u(a, row).dot(block * u(b, column));
                              if (row != column) energy += u(b, row).dot(block * u(a, column));
                            });
  return energy / std::pow(n * edge, 3);
}

Eigen::Matrix3d strain(int i, int j, double size) {
  Eigen::Matrix3d e = Eigen::Matrix3d::Zero();
  e(i, j) += size / 2;
  e(j, i) += size / 2;
  return e;
}

const msm::CellStiffness with_volume = {0.031, 0.047, 0.033, 0.14};

} // namespace

TEST_CASE("every interior point of an affinely deformed lattice is in equilibrium", "[verification]") {
  const int n = 4;
  const double edge = 1.3;
  const cases::Mesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(n * edge), {n, n, n});
  const msm::Lattice lattice = msm::make_lattice(mesh, {with_volume});
  Eigen::Matrix3d deformation;
  deformation << 1.2, 0.3, -0.1, 0.05, 0.9, 0.2, 0.1, -0.15, 1.1;
  msm::Points positions = lattice.rest;
  for (Eigen::Vector3d& x : positions) x = deformation * x;
  const msm::Points force = msm::internal_force(lattice, positions);
  double scale = 0;
  for (const Eigen::Vector3d& f : force) scale = larger(scale, f.norm());
  int n_interior = 0;
  for (std::size_t p = 0; p < force.size(); ++p) {
    const Eigen::Vector3d& x = lattice.rest[p];
    if (x.minCoeff() < 0.1 || x.maxCoeff() > n * edge - 0.1) continue;
    ++n_interior;
    CHECK(force[p].norm() <= 1e-13 * scale); // round-off of 26 springs and 8 cells
  }
  CHECK(n_interior == (n - 1) * (n - 1) * (n - 1));
}

TEST_CASE("the closed moduli are the assembled lattice's affine stiffness", "[verification]") {
  const double edge = 1.6;
  const msm::LatticeModuli moduli = closed::lattice_moduli(with_volume, edge);
  const double tolerance = 1e-12; // both exact: round-off of the sum over 64 cells
  CHECK(moduli.c11 ==
        Approx(modulus(with_volume, edge, strain(0, 0, 1), strain(0, 0, 1))).epsilon(tolerance));
  CHECK(moduli.c12 ==
        Approx(modulus(with_volume, edge, strain(0, 0, 1), strain(1, 1, 1))).epsilon(tolerance));
  CHECK(moduli.c44 ==
        Approx(modulus(with_volume, edge, strain(1, 2, 1), strain(1, 2, 1))).epsilon(tolerance));
}

TEST_CASE("closed moduli and the cell's affine response agree to round-off", "[verification]") {
  const double edge = 0.7;
  const msm::LatticeModuli closed = closed::lattice_moduli(with_volume, edge);
  const msm::LatticeModuli affine = msm::averaged_moduli(msm::cell_elasticity(with_volume, msm::cube(edge)));
  const double tolerance = 1e-13; // the same finite sums in another order
  CHECK(affine.c11 == Approx(closed.c11).epsilon(tolerance));
  CHECK(affine.c12 == Approx(closed.c12).epsilon(tolerance));
  CHECK(affine.c44 == Approx(closed.c44).epsilon(tolerance));
}

TEST_CASE("without a volume term the lattice obeys the Cauchy relation C12 = C44") {
  const msm::LatticeModuli moduli = closed::lattice_moduli({0.02, 0.05, 0.01, 0}, 2.0);
  CHECK(moduli.c12 == moduli.c44);
}

TEST_CASE("the edge of a cube is recognised and that of a cuboid refused") {
  CHECK(msm::cube_edge(msm::cube(2.5)) == Approx(2.5).epsilon(1e-15)); // a sum and a square root
  msm::CellVertices cuboid = msm::cube(1);
  for (Eigen::Vector3d& x : cuboid) x.z() *= 1.001;
  CHECK(msm::cube_edge(cuboid) == 0);
}

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
        Approx(0.1).epsilon(round_off)); // nu errs most; G errs by 8 %
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
  // The thesis's springs alone, as published, have E along the axes and nu = 1/4 at nu = 1/4.
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
