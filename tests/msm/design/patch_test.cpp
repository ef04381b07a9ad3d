#include "msm/design/patch.hpp"

#include "mechanics/dense.hpp"
#include "msm/design/by_shape.hpp"
#include "msm/design/small_strain.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/tetrahedra.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

using namespace springproof;

using cases::index;
using Eigen::Vector3d;

namespace {

cases::Mesh disturbed_box(cases::CellShape shape) {
  cases::Mesh mesh = shape == cases::CellShape::tetrahedron ? bodies::box_of_tetrahedra({3, 3, 3})
                                                            : cases::make_box_mesh({3, 3, 3}, {3, 3, 3});
  mesh.nodes.stored() = bodies::disturbed(mesh.nodes.to_vector(), 0.15);
  mesh.grid.reset();
  return mesh;
}

msm::SpringBody body_of(std::vector<msm::CellTerms> cells) {
  msm::BodyTerms body{std::move(cells)};
  for (std::size_t c = 0; c < body.kinds.size(); ++c) body.kind_of_cell.push_back(static_cast<int>(c));
  return body;
}

std::vector<msm::CellTerms> fitted(const cases::Mesh& mesh, double poissons_ratio) {
  const auto moduli = mechanics::elastic_moduli(cases::LinearElastic{0.3, poissons_ratio});
  return msm::fit_by_shape(mesh, {std::vector(mesh.cells.size(), moduli), 0.8}).cells;
}

double volume_of(const cases::Mesh& mesh) {
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    volume += cases::cell_volume(cases::cell_corners(mesh, c));
  return volume;
}

std::vector<bool> inner_nodes(const cases::Mesh& mesh) {
  std::vector<bool> is_inner(mesh.nodes.size(), true);
  for (const cases::FaceNodes& face : cases::boundary_faces(mesh))
    for (const int node : face) is_inner[index(node)] = false;
  return is_inner;
}

/// The displacements of all nodes under the unit strains xx, yy, zz, yz, xz, xy.
Eigen::MatrixXd uniform_strains(const cases::Mesh& mesh) {
  static constexpr int axes[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  Eigen::MatrixXd all(3 * mesh.nodes.size(), 6);
  for (int s = 0; s < 6; ++s) {
    Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
    strain(axes[s][0], axes[s][1]) += 0.5;
    strain(axes[s][1], axes[s][0]) += 0.5;
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      all.block<3, 1>(static_cast<Eigen::Index>(3 * n), s) = strain * mesh.nodes[n];
  }
  return all;
}

} // namespace

TEST_CASE("the cells' energies of uniform strains add up to the body's", "[verification]") {
  const cases::Mesh mesh =
      disturbed_box(GENERATE(cases::CellShape::hexahedron, cases::CellShape::tetrahedron));
  std::vector<msm::CellTerms> cells = fitted(mesh, 0.4);
  if (mesh.shape == cases::CellShape::hexahedron)
    for (msm::CellTerms& cell : cells) cell.midlines.push_back({1, 0.2});
  msm::Elasticity sum = msm::Elasticity::Zero();
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const cases::CellCorners corners = cases::cell_corners(mesh, c);
    sum += cases::cell_volume(corners) * msm::cell_elasticity(cells[c], corners);
  }
  const Eigen::MatrixXd motions = uniform_strains(mesh);
  const msm::Elasticity whole =
      motions.transpose() * msm::free_stiffness(msm::make_lattice(mesh, body_of(cells))) * motions;
  CHECK((whole - sum).norm() < 1e-11 * sum.norm()); // rounding of some thousand terms
}

TEST_CASE("inner nodes give up the energy of their equilibrium under a strain of the boundary",
          "[verification]") {
  const cases::Mesh mesh =
      disturbed_box(GENERATE(cases::CellShape::hexahedron, cases::CellShape::tetrahedron));
  const msm::Lattice lattice = msm::make_lattice(mesh, body_of(fitted(mesh, 0.4)));
  const std::vector<bool> is_inner = inner_nodes(mesh);
  std::vector<Eigen::Index> free;
  for (std::size_t n = 0; n < is_inner.size(); ++n)
    for (std::size_t c = 0; is_inner[n] && c < 3; ++c) free.push_back(static_cast<Eigen::Index>(3 * n + c));
  REQUIRE(free.size() == 24);
  const Eigen::MatrixXd stiffness = msm::free_stiffness(lattice), uniform = uniform_strains(mesh);
  Eigen::MatrixXd motion = uniform;
  motion(free, Eigen::all) -=
      Eigen::MatrixXd(stiffness(free, free)).ldlt().solve((stiffness * uniform)(free, Eigen::all));
  const double volume = volume_of(mesh);
  const msm::Elasticity released =
      (uniform.transpose() * stiffness * uniform - motion.transpose() * stiffness * motion) / volume;
  const auto [found, is_stable] = msm::relax(lattice, is_inner, volume);
  CHECK(is_stable);
  CHECK(found.norm() > 1e-4);               // this mesh does relax
  CHECK((found - released).norm() < 1e-11); // rounding, beside moduli of 0.3 MPa
}

TEST_CASE("biquadratic springs have the material's moduli in every cell, and do not relax",
          "[verification]") {
  const cases::Mesh mesh = disturbed_box(cases::CellShape::tetrahedron);
  const cases::LinearElastic material{0.3, 0.4};
  const msm::Elasticity wanted = *msm::elasticity_at_rest(material);
  std::vector<msm::CellTerms> cells;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const cases::CellCorners x = cases::cell_corners(mesh, c);
    cells.push_back(msm::in_tetrahedron(cases::Design::biquadratic, {x[0], x[1], x[2], x[3]}, material));
    CHECK(msm::strain_misfit(msm::cell_elasticity(cells.back(), x), wanted) < 1e-12);
  }
  const auto [released, is_stable] =
      msm::relax(msm::make_lattice(mesh, body_of(cells)), inner_nodes(mesh), volume_of(mesh));
  CHECK(is_stable);
  CHECK(released.norm() < 1e-12 * wanted.norm());
}

TEST_CASE("the misfit is that of a cell's fit where springs alone have the material's ratio") {
  const cases::Mesh mesh = disturbed_box(cases::CellShape::tetrahedron);
  const cases::LinearElastic cauchy{0.3, 0.25}; // K = 5/3 mu: no volume term
  for (const std::size_t c : {std::size_t{0}, std::size_t{50}}) {
    const cases::CellCorners corners = cases::cell_corners(mesh, c);
    const msm::CellFit fit = msm::fit_cell(corners, mechanics::elastic_moduli(cauchy), 0.8);
    msm::CellTerms terms;
    for (std::size_t s = 0; s < fit.stiffness.size(); ++s)
      terms.springs.push_back({msm::springs_of(mesh.shape)[s], fit.stiffness[s]});
    CHECK(msm::strain_misfit(msm::cell_elasticity(terms, corners), *msm::elasticity_at_rest(cauchy)) ==
          Approx(fit.misfit).epsilon(1e-9));
  }
}

TEST_CASE("zero modes are what a free body has beside its rigid motions, and they name their nodes") {
  // A tetrahedron of springs, and a fifth point that hangs on one spring: it swings in two directions.
  cases::Mesh mesh;
  mesh.shape = cases::CellShape::tetrahedron;
  mesh.nodes.stored() = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 0.5}};
  msm::Network springs;
  for (int a = 0; a < 4; ++a)
    for (int b = a + 1; b < 4; ++b) springs.push_back({a, b, 0.3});
  const bool hangs = GENERATE(false, true);
  for (int a = 0; a < (hangs ? 1 : 3); ++a) springs.push_back({a, 4, 0.2});
  const msm::Lattice lattice = msm::make_lattice(mesh, springs);
  const mechanics::Spectrum modes = mechanics::spectrum(Eigen::MatrixXd(msm::free_stiffness(lattice)));
  const Eigen::Index n_zero = (modes.values.array() < 1e-9).count(); // the others are above 1e-3
  const msm::ZeroModes found = msm::zero_modes(lattice.rest, modes.vectors.leftCols(n_zero));
  CHECK(found.n == (hangs ? 2 : 0));
  CHECK(found.nodes == (hangs ? std::vector{4} : std::vector<int>()));
}

TEST_CASE("free nodes without a stable equilibrium are said to have none") {
  const cases::Mesh mesh = disturbed_box(cases::CellShape::tetrahedron);
  std::vector<msm::CellTerms> cells = fitted(mesh, 0.3);
  for (msm::CellTerms& cell : cells)
    for (msm::CellSpring& spring : cell.springs) spring.stiffness *= -1;
  CHECK_FALSE(
      msm::relax(msm::make_lattice(mesh, body_of(cells)), inner_nodes(mesh), volume_of(mesh)).is_stable);
}
