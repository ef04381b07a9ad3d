#include "msm/design/lattice_moduli.hpp"

#include <catch2/catch.hpp>

namespace {

// Energy of a block of cells under the affine displacement u = (gradient) x, per volume of the central
// region: each cell contributes its own springs at the stiffness it adds to shared ones, so a block of n^3
// cells has n^3 times the energy of the cell and the boundary needs no correction.
double energy_density(const msm::CellStiffness& stiffness, double edge, const Eigen::Matrix3d& gradient) {
  const int n = 4;
  const cases::HexMesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(n * edge), {n, n, n});
  const msm::Lattice lattice = msm::make_lattice(mesh, {stiffness});
  msm::Points positions = lattice.rest;
  for (Eigen::Vector3d& x : positions) x += gradient * x;
  return msm::energy(lattice, positions) / std::pow(n * edge, 3);
}

Eigen::Matrix3d strain(int i, int j, double size) {
  Eigen::Matrix3d e = Eigen::Matrix3d::Zero();
  e(i, j) += size / 2;
  e(j, i) += size / 2;
  return e;
}

// Second derivative of the energy density by a central difference of fourth order; the energy is smooth.
double curvature(const msm::CellStiffness& stiffness, double edge, const Eigen::Matrix3d& direction) {
  const double h = 5e-3;
  const auto w = [&](double s) { return energy_density(stiffness, edge, s * direction); };
  return (-w(2 * h) + 16 * w(h) + 16 * w(-h) - w(-2 * h)) / (12 * h * h);
}

const msm::CellStiffness stiffness = {0.031, 0.047, 0.033, 0.14};

} // namespace

TEST_CASE("every interior point of an affinely deformed lattice is in equilibrium", "[verification]") {
  const int n = 4;
  const double edge = 1.3;
  const cases::HexMesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(n * edge), {n, n, n});
  const msm::Lattice lattice = msm::make_lattice(mesh, {stiffness});
  Eigen::Matrix3d deformation;
  deformation << 1.2, 0.3, -0.1, 0.05, 0.9, 0.2, 0.1, -0.15, 1.1;
  msm::Points positions = lattice.rest;
  for (Eigen::Vector3d& x : positions) x = deformation * x;
  const msm::Points force = msm::internal_force(lattice, positions);
  double scale = 0;
  for (const Eigen::Vector3d& f : force) scale = std::max(scale, f.norm());
  for (std::size_t p = 0; p < force.size(); ++p) {
    const Eigen::Vector3d& x = lattice.rest[p];
    const bool interior = x.minCoeff() > 0.1 && x.maxCoeff() < n * edge - 0.1;
    if (interior) CHECK(force[p].norm() <= 1e-13 * scale); // round-off of 26 springs and 8 cells
  }
}

TEST_CASE("the closed moduli are the second derivatives of the lattice's energy", "[verification]") {
  const double edge = 1.6;
  const msm::LatticeModuli moduli = msm::lattice_moduli(stiffness, edge);
  const double tolerance =
      1e-6; // the difference's own error: h^4 truncation with h = 5e-3, round-off 1e-16/h²
  const auto sum = [](int i, int j) { return strain(i, i, 1) + strain(j, j, 1); };
  const double c11 = curvature(stiffness, edge, strain(0, 0, 1));
  CHECK(moduli.c11 == Approx(c11).epsilon(tolerance));
  CHECK(moduli.c44 == Approx(curvature(stiffness, edge, strain(1, 2, 1))).epsilon(tolerance));
  CHECK(moduli.c12 == Approx(curvature(stiffness, edge, sum(0, 1)) / 2 - c11).epsilon(tolerance));
}

TEST_CASE("closed moduli and the cell's affine response agree to round-off", "[verification]") {
  const double edge = 0.7;
  const msm::LatticeModuli closed = msm::lattice_moduli(stiffness, edge);
  const msm::LatticeModuli affine = msm::lattice_moduli(stiffness, msm::cube(edge));
  const double tolerance = 1e-13; // the same finite sums in another order
  CHECK(affine.c11 == Approx(closed.c11).epsilon(tolerance));
  CHECK(affine.c12 == Approx(closed.c12).epsilon(tolerance));
  CHECK(affine.c44 == Approx(closed.c44).epsilon(tolerance));
}

TEST_CASE("without a volume term the lattice obeys the Cauchy relation C12 = C44") {
  const msm::LatticeModuli moduli = msm::lattice_moduli({0.02, 0.05, 0.01, 0}, 2.0);
  CHECK(moduli.c12 == moduli.c44);
}

TEST_CASE("the edge of a cube is recognised and that of a cuboid refused") {
  CHECK(msm::cube_edge(msm::cube(2.5)) == Approx(2.5).epsilon(1e-15)); // a sum and a square root
  msm::CellVertices cuboid = msm::cube(1);
  for (Eigen::Vector3d& x : cuboid) x.z() *= 1.001;
  CHECK(msm::cube_edge(cuboid) == 0);
}
