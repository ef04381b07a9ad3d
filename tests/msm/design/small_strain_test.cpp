#include "msm/design/small_strain.hpp"

#include "cases/case/error.hpp"
#include "mechanics/dense.hpp"
#include "msm/design/cells.hpp"
#include "msm/design/design.hpp"
#include "msm/tangent.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

namespace {

// A hexahedron without any symmetry.
msm::CellVertices distorted() {
  msm::CellVertices cell = msm::cube(1.4);
  for (std::size_t v = 0; v < 8; ++v) {
    const double s = static_cast<double>(v);
    cell[v] += 0.12 * Eigen::Vector3d(std::sin(3 * s), std::cos(5 * s), std::sin(7 * s + 1));
  }
  return cell;
}

} // namespace

TEST_CASE("the cell's matrix is the tangent of its lattice at rest", "[verification]") {
  const msm::CellVertices cell = distorted();
  const msm::CellStiffness with_volume = {0.031, 0.047, 0.033, 0.2};
  cases::Mesh mesh;
  mesh.nodes.stored().assign(cell.begin(), cell.end());
  mesh.cells.stored() = {{0, 1, 2, 3, 4, 5, 6, 7}};
  const msm::Lattice lattice = msm::make_lattice(mesh, {with_volume});
  msm::CellMatrix tangent = msm::CellMatrix::Zero();
  msm::visit_tangent_blocks(lattice, lattice.rest, msm::Clamp::no,
                            [&](int row, int column, const Eigen::Matrix3d& block) {
                              tangent.block<3, 3>(3 * row, 3 * column) += block;
                              if (row != column)
                                tangent.block<3, 3>(3 * column, 3 * row) += block.transpose();
                            });
  const msm::CellMatrix matrix = msm::cell_stiffness_matrix(cell, with_volume);
  CHECK((matrix - tangent).norm() <= 1e-13 * matrix.norm()); // round-off: both are the same sums
}

TEST_CASE("a cell of springs has six zero-energy modes and no more", "[verification]") {
  const Eigen::VectorXd eigenvalues =
      mechanics::eigenvalues(msm::cell_stiffness_matrix(distorted(), bodies::thesis_cell));
  const double zero = 1e-12 * eigenvalues(23); // round-off of a dense 24x24 eigenproblem
  CHECK(largest_entry(eigenvalues.head<6>()) <= zero);
  CHECK(eigenvalues(6) > 1e-3 * eigenvalues(23)); // a deformation costs a visible share of the stiffest one
}

TEST_CASE("the linear method returns the springs that a spring matrix was made of", "[verification]") {
  const msm::CellVertices cell = GENERATE(msm::cube(2), distorted());
  const msm::LinearFit fit = msm::linear_method(msm::cell_stiffness_matrix(cell, bodies::thesis_cell), cell);
  const double tolerance = 1e-12; // condition number of the 576x3 least-squares problem is below 10
  CHECK(fit.stiffness.edge == Approx(bodies::thesis_cell.edge).epsilon(tolerance));
  CHECK(fit.stiffness.face_diagonal == Approx(bodies::thesis_cell.face_diagonal).epsilon(tolerance));
  CHECK(fit.stiffness.internal_diagonal == Approx(bodies::thesis_cell.internal_diagonal).epsilon(tolerance));
  CHECK(fit.residual <= 1e-14); // N/mm, of stiffnesses near 0.1: round-off
}

TEST_CASE("no neighbouring stiffness set has a smaller residual") {
  const msm::CellVertices cell = msm::cube(1);
  // Any symmetric matrix will do: this one no springs can represent.
  msm::CellMatrix reference = msm::cell_stiffness_matrix(cell, bodies::thesis_cell);
  reference.diagonal().array() += 0.1;
  const msm::LinearFit fit = msm::linear_method(reference, cell);
  const auto residual = [&](const msm::CellStiffness& k) {
    return (reference - msm::cell_stiffness_matrix(cell, k)).norm();
  };
  CHECK(residual(fit.stiffness) == Approx(fit.residual).epsilon(1e-13)); // the same norm computed twice
  for (const double step : {-1e-3, 1e-3})
    for (double msm::CellStiffness::*member : {&msm::CellStiffness::edge, &msm::CellStiffness::face_diagonal,
                                               &msm::CellStiffness::internal_diagonal}) {
      msm::CellStiffness moved = fit.stiffness;
      moved.*member += step;
      CHECK(residual(moved) > fit.residual);
    }
}

TEST_CASE("the pseudo-stiffness undoes k = (L0/2) k' E") {
  const msm::CellStiffness pseudo = closed::pseudo_stiffness({0.3, 0.6, 0.9, 0}, 3, 0.2);
  CHECK(pseudo.edge == Approx(1).epsilon(1e-15)); // one division
  CHECK(pseudo.face_diagonal == Approx(2).epsilon(1e-15));
  CHECK(pseudo.internal_diagonal == Approx(3).epsilon(1e-15));
}

namespace {

msm::DesignRequest request(cases::Design method, const cases::Material& material, double edge = 1) {
  msm::DesignRequest request;
  request.options.design = method;
  request.material = material;
  request.cell = msm::cube(edge);
  return request;
}

const double round_off = 1e-13; // a dozen arithmetic operations

} // namespace

TEST_CASE("the moduli method's lattice has the Young's and shear modulus asked for", "[verification]") {
  const double nu = GENERATE(-0.2, 0.0, 0.2, 0.25, 0.35, 0.49);
  const double split = GENERATE(0.0, 0.3, 0.7, 1.0);
  const double shear = 0.3 / (2 * (1 + nu));
  const msm::LatticeModuli moduli =
      closed::lattice_moduli(msm::moduli_method(0.3, shear, split, msm::cube(1.7)), 1.7);
  CHECK(moduli.youngs_modulus == Approx(0.3).epsilon(round_off));
  CHECK(moduli.shear_modulus == Approx(shear).epsilon(round_off));
}

TEST_CASE("the hybrid method's lattice is isotropic with the E and nu asked for", "[verification]") {
  const double nu = GENERATE(0.25, 0.3, 0.35, 0.45, 0.49);
  const double split = GENERATE(0.0, 0.3, 0.8, 1.0);
  msm::DesignRequest hybrid = request(cases::Design::hybrid, cases::LinearElastic{0.3, nu}, 0.6);
  hybrid.options.split = split;
  const msm::DesignResult result = msm::design(hybrid);
  CHECK(result.moduli.zener == Approx(1).epsilon(round_off));
  CHECK(result.moduli.youngs_modulus ==
        Approx(0.3).epsilon(100 * round_off)); // lambda/mu = 49 cancels two digits
  CHECK(result.moduli.poissons_ratio == Approx(nu).epsilon(round_off));
}

TEST_CASE("at nu = 1/4 both methods give the same springs without a volume term", "[verification]") {
  const msm::CellStiffness hybrid = msm::hybrid_method(0.12, 0.12, 0.7, msm::cube(1));
  const msm::CellStiffness springs = msm::moduli_method(0.3, 0.12, 0.7, msm::cube(1));
  CHECK(hybrid.edge == Approx(springs.edge).epsilon(round_off));
  CHECK(hybrid.face_diagonal == Approx(springs.face_diagonal).epsilon(round_off));
  CHECK(hybrid.internal_diagonal == Approx(springs.internal_diagonal).epsilon(round_off));
  CHECK(hybrid.volume == 0);
}

TEST_CASE("an incompressible Ogden material has moduli E = 3 mu and G = mu") {
  msm::DesignRequest moduli = request(cases::Design::moduli, cases::Ogden{{0.04332}, {5.7255}, std::nullopt});
  const msm::DesignResult result = msm::design(moduli);
  CHECK(result.moduli.youngs_modulus == Approx(3 * 0.04332).epsilon(round_off));
  CHECK(result.moduli.shear_modulus == Approx(0.04332).epsilon(round_off));
  CHECK(result.warnings == std::vector<std::string>{result.misfit->text}); // nu: springs alone have 1/4
}

TEST_CASE("below nu = 1/4 the hybrid's volume term is negative, and cell and lattice are stable at rest",
          "[verification]") {
  const double nu = GENERATE(0., 0.1, 0.2);
  msm::DesignRequest hybrid = request(cases::Design::hybrid, cases::LinearElastic{0.3, nu}, 0.6);
  hybrid.options.split = GENERATE(0.2, 0.5, 0.8);
  const msm::DesignResult result = msm::design(hybrid);
  CHECK(result.stiffness.volume < 0);
  CHECK(result.moduli.youngs_modulus == Approx(0.3).epsilon(round_off));
  CHECK(result.moduli.poissons_ratio == Approx(nu).margin(round_off));
  CHECK(result.warnings == std::vector<std::string>{"volume term k_v: the stiffness is negative"});
  CHECK(msm::smallest_wave_stiffness(result.stiffness, 0.6, Eigen::Matrix3d::Identity()) > 0);
}

TEST_CASE(
    "the hybrid method refuses Poisson's ratios below 0 and of 1/2, and tells what flat cells miss where the "
    "volume term is negative") {
  msm::DesignRequest flat = request(cases::Design::hybrid, cases::LinearElastic{0.3, 0.});
  for (Eigen::Vector3d& x : flat.cell) x.z() *= 0.05;
  CHECK(msm::design(flat).misfit->largest > 0.5);
  CHECK_THROWS_AS(msm::design(request(cases::Design::hybrid, cases::LinearElastic{0.3, -0.01})),
                  cases::InputError);
  CHECK_THROWS_AS(msm::design(request(cases::Design::hybrid, cases::LinearElastic{0.3, 0.5})),
                  cases::InputError);
}

TEST_CASE("fitted to a cube, both methods are their closed forms", "[verification]") {
  const double split = GENERATE(0.3, 0.8);
  const double lambda = 0.3, mu = 0.1, h = 1.4, internal = 0.75 * split * mu * h, face = (1 - split) * mu * h;
  const msm::CellStiffness closed = {(face + 8 * internal / 3) / 4, face / 2, internal, lambda - mu};
  const msm::CellStiffness fitted = msm::hybrid_method(lambda, mu, split, msm::cube(h));
  CHECK(fitted.edge == Approx(closed.edge).epsilon(1e-12)); // a 36x2 least-squares problem: round-off
  CHECK(fitted.face_diagonal == Approx(closed.face_diagonal).epsilon(1e-12));
  CHECK(fitted.internal_diagonal == Approx(closed.internal_diagonal).epsilon(1e-12));
  CHECK(fitted.volume == Approx(closed.volume).epsilon(1e-12));
  const double e = 0.3, g = 0.11, c11 = (e - g + std::sqrt((e + g) * (e + g) + 8 * g * g)) / 2;
  const double edges = c11 * h - 2 * (1 - split) * g * h - split * g * h; // K_e = C11 h - 2 K_f - 4 K_d/3
  CHECK(msm::moduli_method(e, g, split, msm::cube(h)).edge == Approx(edges / 4).epsilon(1e-12));
}

TEST_CASE("a slightly distorted cell is given slightly different springs") {
  msm::DesignRequest distorted = request(cases::Design::hybrid, cases::LinearElastic{0.3, 0.4});
  const msm::DesignResult cube = msm::design(distorted);
  for (std::size_t v = 0; v < 8; ++v)
    distorted.cell[v] += 0.02 * Eigen::Vector3d::Unit(static_cast<int>(v % 3));
  const msm::DesignResult result = msm::design(distorted);
  CHECK(result.warnings.empty());
  CHECK(result.stiffness.edge ==
        Approx(cube.stiffness.edge).epsilon(0.1)); // vertices moved by 2 %, spring by a few times that
  CHECK(result.stiffness.edge != cube.stiffness.edge);
  CHECK(result.moduli.poissons_ratio == Approx(0.4).epsilon(0.05)); // likewise
}

TEST_CASE("both methods refuse a split outside [0, 1]") {
  const cases::Design method = GENERATE(cases::Design::moduli, cases::Design::hybrid);
  msm::DesignRequest split = request(method, cases::LinearElastic{0.3, 0.3});
  split.options.split = GENERATE(-0.1, 1.1, std::nan(""));
  CHECK_THROWS_AS(msm::design(split), cases::InputError);
}

TEST_CASE("designs that are fitted to homogeneous tests of a cube refuse another cell") {
  const cases::Design method = GENERATE(cases::Design::nonlinear_method, cases::Design::multi_load);
  msm::DesignRequest cuboid = request(method, cases::LinearElastic{0.3, 0.3});
  for (Eigen::Vector3d& x : cuboid.cell) x.x() *= 2;
  CHECK_THROWS_AS(msm::design(cuboid), cases::InputError);
}
