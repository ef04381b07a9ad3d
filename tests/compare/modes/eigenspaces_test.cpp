#include "compare/modes/modes.hpp"

#include "compare/solve/springs.hpp"
#include "compare/thesis/regenerate.hpp"
#include "fem_reference/element_stiffness.hpp"
#include "tests/support/largest.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <random>

using namespace springproof;

namespace {

struct Matrices {
  msm::CellMatrix fem, msm;
};

// The thesis's cell: E = 1, edge 2, designed by the linear method.
Matrices cell_matrices(double poissons_ratio) {
  const cases::LinearElastic material{1, poissons_ratio};
  const msm::CellVertices cell = msm::cube(2);
  const msm::DesignResult design = msm::design(compare::design_request(material, cell, cases::Msm{}));
  return {fem_reference::element_stiffness(cell, material, cases::Element::q1),
          msm::cell_stiffness_matrix(cell, design.stiffness)};
}

compare::EigenspaceAnalysis analyse(double poissons_ratio) {
  const Matrices matrices = cell_matrices(poissons_ratio);
  return compare::analyse_eigenspaces(mechanics::spectrum(matrices.fem), mechanics::spectrum(matrices.msm));
}

Eigen::MatrixXd random_rotation(Eigen::Index n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd entries = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
  return Eigen::HouseholderQR<Eigen::MatrixXd>(entries).householderQ();
}

void rotate_inside_spaces(compare::Spectrum& spectrum, std::mt19937& random) {
  for (const compare::Eigenspace& space : compare::cluster(spectrum.values))
    spectrum.vectors.middleCols(space.offset, space.dimension) *= random_rotation(space.dimension, random);
}

} // namespace

TEST_CASE("Table 4.2: eigenvalues and multiplicities of both cells at nu = 0", "[verification]") {
  const compare::EigenspaceAnalysis analysis = analyse(0);
  std::size_t n_spaces = 0;
  for (const compare::PublishedFigure& figure : compare::published_figures()) {
    if (figure.table != "4.2") continue;
    CAPTURE(figure.measure);
    const std::size_t index = std::stoul(figure.measure.substr(figure.measure.rfind('_') + 1)) - 1;
    const auto& spaces = figure.measure.rfind("fem", 0) == 0 ? analysis.fem_spaces : analysis.msm_spaces;
    REQUIRE(index < spaces.size());
    if (figure.measure.find("multiplicity") != std::string::npos) {
      ++n_spaces;
      CHECK(spaces[index].dimension == figure.value);
    } else { // two printed digits, and the thesis computed from stiffnesses rounded to three: half a unit of
             // each
      CHECK(spaces[index].eigenvalue == Approx(figure.value).margin(0.0075));
    }
  }
  CHECK(n_spaces == analysis.fem_spaces.size() + analysis.msm_spaces.size());
}

TEST_CASE("Table 4.3: all eleven h to the printed digit", "[verification]") {
  int n = 0;
  for (const compare::PublishedFigure& figure : compare::published_figures()) {
    if (figure.table != "4.3") continue;
    ++n;
    CAPTURE(figure.poissons_ratio);
    CHECK(analyse(figure.poissons_ratio).h ==
          Approx(figure.value).margin(0.005 + 1e-12)); // half of the last digit
  }
  CHECK(n == 11);
}

TEST_CASE("rotating the basis inside degenerate spaces changes nothing", "[verification]") {
  std::mt19937 random(7);
  for (const double nu : {0.0, 0.2, 0.35, 0.49}) {
    const compare::EigenspaceAnalysis before = analyse(nu);
    compare::Spectrum fem = before.fem, msm = before.msm;
    rotate_inside_spaces(fem, random);
    rotate_inside_spaces(msm, random);
    const compare::EigenspaceAnalysis after = compare::analyse_eigenspaces(fem, msm);
    CAPTURE(nu);
    CHECK((fem.vectors - before.fem.vectors).norm() > 1); // the rotation did turn the bases
    CHECK(after.h == before.h);
    CHECK(largest_entry(after.coupling - before.coupling) <= 1e-13); // round-off of orthogonal products
    REQUIRE(after.equivalent.size() == before.equivalent.size());
    for (std::size_t e = 0; e < after.equivalent.size(); ++e) {
      CHECK(after.equivalent[e].fem_space == before.equivalent[e].fem_space);
      CHECK(after.equivalent[e].msm_space == before.equivalent[e].msm_space);
    }
    for (const compare::Eigenspace& space : before.msm_spaces) {
      const Eigen::MatrixXd difference = compare::canonical_basis(compare::basis(before.msm, space)) -
                                         compare::canonical_basis(compare::basis(after.msm, space));
      CHECK(difference.norm() <= 1e-12); // round-off
    }
  }
}

TEST_CASE("the spectrum of a cell is that of the solver for its size", "[verification]") {
  const Matrices matrices = cell_matrices(0.35);
  for (const msm::CellMatrix& matrix : {matrices.fem, matrices.msm}) {
    const compare::Spectrum spectrum = mechanics::spectrum(matrix);
    const Eigen::VectorXd expected = Eigen::SelfAdjointEigenSolver<msm::CellMatrix>(matrix).eigenvalues();
    const double round_off = 1e-13 * expected(23);
    CHECK(largest_entry(spectrum.values - expected) <= round_off);
    CHECK((matrix * spectrum.vectors - spectrum.vectors * spectrum.values.asDiagonal()).norm() <=
          10 * round_off);
    CHECK((spectrum.vectors.transpose() * spectrum.vectors - Eigen::MatrixXd::Identity(24, 24)).norm() <=
          1e-12);
  }
}

TEST_CASE("a matrix compared with itself has every space equivalent in place", "[verification]") {
  const compare::Spectrum spectrum = mechanics::spectrum(cell_matrices(0.3).fem);
  const compare::EigenspaceAnalysis analysis = compare::analyse_eigenspaces(spectrum, spectrum);
  const double n = static_cast<double>(analysis.fem_spaces.size());
  CHECK(analysis.h == Approx((n + 1) / 2).epsilon(1e-14)); // sum of i/N
  CHECK((analysis.coupling - Eigen::MatrixXd::Identity(analysis.coupling.rows(), analysis.coupling.cols()))
            .norm() <= 1e-12); // orthonormality of the solver's vectors
}

TEST_CASE("the share of a space in all spaces of the other matrix is one", "[verification]") {
  const compare::EigenspaceAnalysis analysis = analyse(0.1);
  CHECK(largest_entry((analysis.coupling.rowwise().sum().array() - 1).matrix()) <=
        1e-12); // completeness, round-off
}

namespace {

Eigen::SparseMatrix<double> free_cube(int n, double scale) {
  const cases::Mesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(n), {{n, n, n}});
  const msm::CellMatrix cell =
      scale * fem_reference::element_stiffness(msm::cube(1), {1, 0.3}, cases::Element::q1);
  return compare::assemble(mesh, cell);
}

} // namespace

TEST_CASE("a body twice as stiff has the same modes at twice the eigenvalues", "[verification]") {
  const compare::FreeBodyModes modes = compare::free_body_modes(free_cube(3, 1), free_cube(3, 2), 12);
  REQUIRE(modes.pairs.size() >= 3);
  for (const compare::ModePair& pair : modes.pairs) {
    CHECK(pair.ratio ==
          Approx(2).epsilon(1e-8)); // the eigensolver's tolerance, 1e-12 of the shifted operator
    CHECK(pair.fem.dimension == pair.msm.dimension);
    CHECK(pair.angle_degrees <= 0.01); // acos of 1 - 1e-8
  }
}

TEST_CASE("the sparse solver's lowest modes are those of the dense one, six of them rigid",
          "[verification]") {
  const Eigen::SparseMatrix<double> matrix = free_cube(2, 1);
  const compare::Spectrum lowest = compare::solvers().lowest_spectrum(matrix, 20);
  const compare::Spectrum all = mechanics::spectrum(Eigen::MatrixXd(matrix));
  const double tolerance = 1e-9 * all.values(80); // 1e-12 on the shifted inverse, times shift to spectrum
  CHECK(largest_entry(lowest.values - all.values.head(20)) <= tolerance);
  CHECK(largest_entry(lowest.values.head(6)) <= tolerance);
  CHECK(lowest.values(6) > 1e-3);
}
