#include "compare/modes/eigenspaces.hpp"

#include "fem_reference/element_stiffness.hpp"
#include "mechanics/cell_mass.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

namespace {

constexpr double edge = 10, density = 1e-9, shear_modulus = 0.1; // mm, t/mm³, MPa

/// The Lamé mode of a free cube in the plane of x and y, which shears without changing volume.
Eigen::VectorXd lame_shape(const cases::HexMesh& mesh) {
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * mesh.nodes.size()));
  const double k = std::acos(-1.0) / edge;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Eigen::Vector3d at = mesh.nodes[n];
    shape[static_cast<Eigen::Index>(3 * n)] = std::cos(k * at.x()) * std::sin(k * at.y());
    shape[static_cast<Eigen::Index>(3 * n + 1)] = -std::sin(k * at.x()) * std::cos(k * at.y());
  }
  return shape;
}

/// Frequency (Hz) of the finite elements' mode that the Lamé mode overlaps most.
double lame_frequency(int n, double poissons_ratio) {
  const cases::HexMesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(edge), {{n, n, n}});
  const auto vertices = cases::cell_vertices(mesh, 0);
  const double young = 2 * shear_modulus * (1 + poissons_ratio);
  const auto stiffness = compare::assemble(
      mesh, fem_reference::element_stiffness(vertices, {young, poissons_ratio}, cases::Element::q1));
  const auto mass = compare::assemble(mesh, mechanics::consistent_mass(vertices, density));
  const compare::Spectrum modes = compare::lowest_vibrations(stiffness, mass, 40);
  const Eigen::VectorXd shape = lame_shape(mesh), weighted = mass * shape;
  const Eigen::VectorXd overlap = modes.vectors.transpose() * weighted;
  // The modes of three planes have one frequency: any of their space will do.
  Eigen::Index most = 0;
  overlap.cwiseAbs().maxCoeff(&most);
  double in_space = 0;
  for (Eigen::Index i = 0; i < overlap.size(); ++i)
    if (std::abs(modes.values[i] - modes.values[most]) <= 1e-6 * modes.values[most])
      in_space += overlap[i] * overlap[i];
  CHECK(in_space >= 0.95 * shape.dot(weighted));
  return std::sqrt(modes.values[most]) / (2 * std::acos(-1.0));
}

} // namespace

TEST_CASE("the Lame mode of a free cube is approached at order 2, whatever Poisson's ratio", "[verification]") {
  const double exact = std::sqrt(shear_modulus / density) / (std::sqrt(2.0) * edge); // Hz
  for (const double nu : {0.0, 0.3}) {
    INFO("nu " << nu);
    const double coarse = lame_frequency(4, nu) / exact - 1, fine = lame_frequency(8, nu) / exact - 1;
    CHECK(fine < 0.02);
    CHECK(std::log2(coarse / fine) == Approx(2).margin(0.1)); // the next power of the cell's size
  }
}

TEST_CASE("a free body has six vibrations of frequency 0, and modes of unit mass", "[verification]") {
  const cases::HexMesh mesh = cases::make_box_mesh({20, 10, 10}, {{4, 2, 2}});
  const auto vertices = cases::cell_vertices(mesh, 0);
  const auto stiffness =
      compare::assemble(mesh, fem_reference::element_stiffness(vertices, {1, 0.3}, cases::Element::q1));
  const auto mass = compare::assemble(mesh, mechanics::consistent_mass(vertices, density));
  const compare::Spectrum modes = compare::lowest_vibrations(stiffness, mass, 12);
  CHECK(modes.values.head(6).cwiseAbs().maxCoeff() <= 1e-8 * modes.values[6]);
  const Eigen::MatrixXd products = modes.vectors.transpose() * (mass * modes.vectors);
  CHECK((products - Eigen::MatrixXd::Identity(12, 12)).norm() <= 1e-8);
}
