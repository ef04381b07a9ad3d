#include "compare/modes/modes.hpp"

#include "compare/solve/springs.hpp"
#include "fem_reference/element_stiffness.hpp"
#include "msm/moving_springs.hpp"
#include "tests/support/cell_mass.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

namespace {

constexpr double edge = 10, density = 1e-9, shear_modulus = 0.1; // mm, t/mm³, MPa

/// Combines the Lamé modes of a free cube, which shear in three planes without changing volume: twice the one
/// in the plane of x and y less those in the others. The sum of all three has another symmetry than this, and
/// on a mesh another frequency.
Eigen::VectorXd lame_shape(const cases::Mesh& mesh) {
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * mesh.nodes.size()));
  const double k = std::acos(-1.0) / edge;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Eigen::Vector3d at = mesh.nodes[n];
    for (int i = 0; i < 3; ++i) { // the plane of axes i and j
      const int j = (i + 1) % 3;
      const double part = i == 0 ? 2 : -1;
      const auto first = static_cast<Eigen::Index>(3 * n);
      shape[first + i] += part * std::cos(k * at[i]) * std::sin(k * at[j]);
      shape[first + j] -= part * std::sin(k * at[i]) * std::cos(k * at[j]);
    }
  }
  return shape;
}

/// Frequency (Hz) of the mode of a free cube that the Lamé mode overlaps most.
double lame_frequency(const cases::Mesh& mesh, const Eigen::SparseMatrix<double>& stiffness,
                      const Eigen::SparseMatrix<double>& mass) {
  const compare::Spectrum modes = compare::solvers().lowest_vibrations(stiffness, mass, 40);
  const Eigen::VectorXd shape = lame_shape(mesh), weighted = mass * shape;
  const Eigen::VectorXd overlap = modes.vectors.transpose() * weighted;
  // Two modes have one frequency: any of their space will do.
  Eigen::Index most = 0;
  overlap.cwiseAbs().maxCoeff(&most);
  double in_space = 0;
  for (Eigen::Index i = 0; i < overlap.size(); ++i)
    if (std::abs(modes.values[i] - modes.values[most]) <= 1e-6 * modes.values[most])
      in_space += overlap[i] * overlap[i];
  CHECK(in_space >= 0.95 * shape.dot(weighted));
  return std::sqrt(modes.values[most]) / (2 * std::acos(-1.0));
}

cases::LinearElastic material(double poissons_ratio) {
  return {2 * shear_modulus * (1 + poissons_ratio), poissons_ratio};
}

/// Frequency (Hz) of the Lamé mode of finite elements, n along an edge.
double lame_frequency(int n, double poissons_ratio) {
  const cases::Mesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(edge), {{n, n, n}});
  const auto vertices = cases::cell_vertices(mesh, 0);
  return lame_frequency(mesh,
                        compare::assemble(mesh, fem_reference::element_stiffness(
                                                    vertices, material(poissons_ratio), cases::Element::q1)),
                        compare::assemble(mesh, mechanics::consistent_mass(vertices, density)));
}

/// A free cube of springs, n cells along an edge.
cases::Case cube_of_springs(int n, double poissons_ratio, cases::Design design, cases::PointMass mass) {
  cases::Case definition;
  definition.body = cases::Box{Eigen::Vector3d::Constant(edge), {n, n, n}};
  definition.material = material(poissons_ratio);
  definition.material_dynamics.density = 1e12 * density; // kg/m³
  definition.msm.design = design;
  definition.msm.mass = mass;
  return definition;
}

/// Frequency (Hz) of the Lamé mode of springs.
double lame_frequency(int n, double poissons_ratio, cases::Design design,
                      cases::PointMass mass = cases::PointMass::cells) {
  const cases::Scene scene = cases::make_scene(cube_of_springs(n, poissons_ratio, design, mass));
  const auto body =
      msm::vibrating_body(scene, msm::make_lattice(scene.mesh, compare::design_for(scene).springs));
  return lame_frequency(scene.mesh, body.stiffness, body.mass);
}

} // namespace

TEST_CASE("springs whose lattice has the material's moduli approach the Lame mode too", "[verification]") {
  const double exact = std::sqrt(shear_modulus / density) / (std::sqrt(2.0) * edge); // Hz
  for (const auto design : {cases::Design::hybrid, cases::Design::moduli}) {
    const double nu = design == cases::Design::moduli ? 0.25 : 0.3; // the ratio that pairwise springs have
    INFO(cases::name_of(design));
    const double coarse = std::abs(lame_frequency(4, nu, design) / exact - 1),
                 fine = std::abs(lame_frequency(8, nu, design) / exact - 1);
    CHECK(fine < 0.03);
    CHECK(fine < 0.5 * coarse); // the order is between 1 and 2: boundary springs belong to fewer cells
  }
}

TEST_CASE("the Lame mode of a free cube is approached at order 2, whatever Poisson's ratio",
          "[verification][long]") {
  const double exact = std::sqrt(shear_modulus / density) / (std::sqrt(2.0) * edge); // Hz
  for (const double nu : {0.1, 0.3}) {
    INFO("nu " << nu);
    const double coarse = lame_frequency(8, nu) / exact - 1, fine = lame_frequency(16, nu) / exact - 1;
    CHECK(fine < 0.02);
    CHECK(std::log2(coarse / fine) == Approx(2).margin(0.1)); // the next power of the cell's size
  }
}

TEST_CASE("consistent masses of springs are integrals of N_a N_b, on cells of any shape", "[verification]") {
  const cases::Case definition = cube_of_springs(3, 0.3, cases::Design::hybrid, cases::PointMass::consistent);
  cases::Scene scene = cases::make_scene(definition);
  const msm::Lattice lattice = msm::make_lattice(scene.mesh, compare::design_for(scene).springs);
  const auto mass_of = [&] { return msm::vibrating_body(scene, lattice).mass; };
  for (Eigen::Vector3d& x : scene.mesh.nodes.stored()) x += Eigen::Vector3d(0.4 * x.y(), 0, 0.3 * x.x());
  const auto expected =
      compare::assemble(scene.mesh, mechanics::consistent_mass(cases::cell_vertices(scene.mesh, 0), density));
  CHECK((mass_of() - expected).norm() <= 1e-14 * expected.norm()); // rounding
  // No two cells alike: all of the body's mass, for each component.
  for (Eigen::Vector3d& x : scene.mesh.nodes.stored())
    x += 0.3 * Eigen::Vector3d(std::sin(7 * x.z()), std::sin(5 * x.x()), std::sin(9 * x.y()));
  double volume = 0;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    volume += cases::cell_volume(cases::cell_corners(scene.mesh, c));
  CHECK(mass_of().sum() == Approx(3 * density * volume).epsilon(1e-13));
  const cases::AddedMass weight{cases::Region{"x+"}, 1e-6}; // kg
  const Eigen::SparseMatrix<double> without = mass_of();
  scene.masses.push_back({cases::select(scene.mesh, weight.region), weight});
  const Eigen::SparseMatrix<double> added = (mass_of() - without).pruned(1, 1e-20);
  CHECK(added.sum() == Approx(3e-9).epsilon(1e-9)); // t; as it was on the diagonal
  CHECK(added.diagonal().sum() == Approx(added.sum()).epsilon(1e-12));
}

TEST_CASE("a free body has six vibrations of frequency 0, and modes of unit mass", "[verification]") {
  const cases::Mesh mesh = cases::make_box_mesh({20, 10, 10}, {{4, 2, 2}});
  const auto vertices = cases::cell_vertices(mesh, 0);
  const auto stiffness =
      compare::assemble(mesh, fem_reference::element_stiffness(vertices, {1, 0.3}, cases::Element::q1));
  const auto mass = compare::assemble(mesh, mechanics::consistent_mass(vertices, density));
  const compare::Spectrum modes = compare::solvers().lowest_vibrations(stiffness, mass, 12);
  CHECK(modes.values.head(6).cwiseAbs().maxCoeff() <= 1e-8 * modes.values[6]);
  const Eigen::MatrixXd products = modes.vectors.transpose() * (mass * modes.vectors);
  CHECK((products - Eigen::MatrixXd::Identity(12, 12)).norm() <= 1e-8);
}
