#include "msm/design/small_strain.hpp"

#include "msm/tangent.hpp"
#include "tests/support/bodies.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

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
  cases::HexMesh mesh;
  mesh.nodes.stored().assign(cell.begin(), cell.end());
  mesh.cells.stored() = {{0, 1, 2, 3, 4, 5, 6, 7}};
  const msm::Lattice lattice = msm::make_lattice(mesh, {with_volume});
  msm::CellMatrix tangent = msm::CellMatrix::Zero();
  msm::visit_tangent_blocks(lattice, lattice.rest, msm::TransverseTerm::exact,
                            [&](int row, int column, const Eigen::Matrix3d& block) {
                              tangent.block<3, 3>(3 * row, 3 * column) += block;
                              if (row != column)
                                tangent.block<3, 3>(3 * column, 3 * row) += block.transpose();
                            });
  const msm::CellMatrix matrix = msm::cell_stiffness_matrix(cell, with_volume);
  CHECK((matrix - tangent).norm() <= 1e-13 * matrix.norm()); // round-off: both are the same sums
}

TEST_CASE("a cell of springs has six zero-energy modes and no more", "[verification]") {
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<msm::CellMatrix>(
                                          msm::cell_stiffness_matrix(distorted(), bodies::thesis_cell))
                                          .eigenvalues();
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
  const msm::CellStiffness pseudo = msm::pseudo_stiffness({0.3, 0.6, 0.9, 0}, 3, 0.2);
  CHECK(pseudo.edge == Approx(1).epsilon(1e-15)); // one division
  CHECK(pseudo.face_diagonal == Approx(2).epsilon(1e-15));
  CHECK(pseudo.internal_diagonal == Approx(3).epsilon(1e-15));
}
