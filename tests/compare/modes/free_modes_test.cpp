#include "compare/modes/free_modes.hpp"

#include "fem_reference/element_stiffness.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace {

Eigen::SparseMatrix<double> free_cube(int n, double scale) {
  const cases::HexMesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(n), {{n, n, n}});
  const msm::CellMatrix cell =
      scale * fem_reference::element_stiffness(msm::cube(1), {1, 0.3}, cases::Element::q1);
  return compare::assemble(mesh, {cell});
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
  const compare::Spectrum lowest = compare::lowest_spectrum(matrix, 20);
  const compare::Spectrum all = compare::full_spectrum(Eigen::MatrixXd(matrix));
  const double tolerance = 1e-9 * all.values(80); // 1e-12 on the shifted inverse, times shift to spectrum
  CHECK(largest_entry(lowest.values - all.values.head(20)) <= tolerance);
  CHECK(largest_entry(lowest.values.head(6)) <= tolerance);
  CHECK(lowest.values(6) > 1e-3);
}
