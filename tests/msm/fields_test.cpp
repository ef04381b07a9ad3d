
#include "mechanics/field_sums.hpp"
#include "msm/design/cells.hpp"
#include "msm/model.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/closed_forms.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <numeric>

using namespace springproof;

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace stress_of_springs {

namespace {

Matrix3d matrix_of(const cases::SymmetricTensor& t) {
  Matrix3d m;
  m << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
  return m;
}

msm::CellStiffness power_log_cell() {
  msm::CellStiffness springs = bodies::cell(31, 47, 33, 0.14);
  springs.exponents = {-1.5, 0.5, 2};
  return springs;
}

cases::Scene body() {
  return cases::make_scene(bodies::clamped_box({2, 2, 3}, bodies::tensile(0)));
}

cases::Solution displaced(msm::Points displacement) {
  cases::Solution solution;
  solution.displacement = std::move(displacement);
  return solution;
}

/// A body deformed affinely, x = F X.
cases::Solution deformed(const cases::Scene& scene, const Matrix3d& f) {
  msm::Points displacement;
  for (const Vector3d& x : scene.mesh.nodes) displacement.push_back((f - Matrix3d::Identity()) * x);
  return displaced(std::move(displacement));
}

cases::Fields affine(const cases::Scene& scene, const msm::CellStiffness& springs, const Matrix3d& f) {
  return msm::fields(scene, std::vector<msm::CellStiffness>{springs}, deformed(scene, f), 0);
}

/// Stiffnesses that differ from axis to axis; tetrahedra; springs that are whole at the boundary.
std::vector<msm::BodyTerms> bodies_of_terms() {
  const msm::CellTerms by_axis = msm::terms_by_axis({{0.02, 0.03, 0.05, 0.011, 0.013, 0.017, 0.019}, 0.14});
  msm::CellTerms tetrahedra;
  const std::vector<std::array<int, 4>> five{
      {0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}};
  for (const auto& vertices : five) tetrahedra.tetrahedra.push_back({vertices, 0.2, 0.1});
  return {msm::BodyTerms{{by_axis}}, msm::BodyTerms{{tetrahedra}},
          msm::BodyTerms{{msm::terms_of(bodies::hybrid_cell)}, {}, msm::Boundary::whole}};
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.);
}

Vector3d sum(const msm::Points& vectors) {
  return std::accumulate(vectors.begin(), vectors.end(), Vector3d(0, 0, 0));
}

Matrix3d finite_deformation() {
  Matrix3d f;
  f << 1.2, 0.3, -0.1, 0.05, 0.9, 0.2, 0.1, -0.15, 1.1;
  return f;
}

} // namespace

TEST_CASE("a lattice under a uniform small strain has the stress of its moduli in every cell",
          "[verification]") {
  const cases::Scene scene = body();
  for (const msm::CellStiffness& springs : {bodies::thesis_cell, bodies::hybrid_cell, power_log_cell()}) {
    const msm::LatticeModuli moduli = closed::lattice_moduli(springs, 1);
    for (int pair = 0; pair < 6; ++pair) {
      const int i = pair < 3 ? pair : pair - 3, j = pair < 3 ? pair : (pair - 2) % 3;
      Matrix3d strain = Matrix3d::Zero();
      strain(i, j) += 0.5;
      strain(j, i) += 0.5;
      Matrix3d expected = 2 * moduli.c44 * (strain - Matrix3d(strain.diagonal().asDiagonal()));
      expected.diagonal() =
          (moduli.c11 - moduli.c12) * strain.diagonal() + moduli.c12 * strain.trace() * Vector3d::Ones();
      // fourth-order derivative with respect to the strain: truncation step⁴ ~ 1e-14, rounding 1e-16/step
      const double step = 3e-4;
      const auto at = [&](double steps) {
        return affine(scene, springs, Matrix3d::Identity() + steps * step * strain).stress;
      };
      const auto one = at(1), minus_one = at(-1), two = at(2), minus_two = at(-2);
      for (std::size_t c = 0; c < one.size(); ++c) {
        const Matrix3d slope = (8 * (matrix_of(one[c]) - matrix_of(minus_one[c])) - matrix_of(two[c]) +
                                matrix_of(minus_two[c])) /
                               (12 * step);
        CAPTURE(pair, c, springs.volume);
        CHECK((slope - expected).norm() <= 1e-10 * expected.norm());
      }
    }
  }
}

TEST_CASE("under a uniform finite strain every cell has the stress that is the derivative of its energy",
          "[verification]") {
  const cases::Scene scene = body();
  const Matrix3d f = finite_deformation();
  for (const msm::CellStiffness& springs : {bodies::thesis_cell, bodies::hybrid_cell, power_log_cell()}) {
    Matrix3d first;           // P = dW/dF of a cell of 1 mm³
    const double step = 1e-3; // truncation step⁴ ~ 1e-12, rounding 1e-16/step
    for (int k = 0; k < 9; ++k) {
      const auto energy = [&](double steps) {
        Matrix3d moved = f;
        moved(k / 3, k % 3) += steps * step;
        return affine(scene, springs, moved).strain_energy[5];
      };
      first(k / 3, k % 3) = (8 * (energy(1) - energy(-1)) - energy(2) + energy(-2)) / (12 * step);
    }
    const Matrix3d cauchy = first * f.transpose() / f.determinant();
    for (const auto& stress : affine(scene, springs, f).stress)
      CHECK((matrix_of(stress) - cauchy).norm() <= 1e-9 * cauchy.norm());
  }
}

TEST_CASE("a superposed rotation turns stress and strain and leaves the energy", "[verification]") {
  const cases::Scene scene = body();
  const Matrix3d f = finite_deformation(),
                 q = Eigen::AngleAxisd(2.2, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const msm::CellStiffness& springs : {bodies::hybrid_cell, power_log_cell()}) {
    const cases::Fields plain = affine(scene, springs, f), turned = affine(scene, springs, q * f);
    for (std::size_t c = 0; c < plain.stress.size(); ++c) {
      const Matrix3d stress = matrix_of(plain.stress[c]), strain = matrix_of(plain.strain[c]);
      // rounding
      CHECK((matrix_of(turned.stress[c]) - q * stress * q.transpose()).norm() <= 1e-12 * stress.norm());
      CHECK((matrix_of(turned.strain[c]) - q * strain * q.transpose()).norm() <= 1e-12 * strain.norm());
      CHECK(turned.strain_energy[c] == Approx(plain.strain_energy[c]).epsilon(1e-12));
      CHECK((strain - mechanics::logarithmic_strain(f - Matrix3d::Identity())).norm() <= 1e-13);
    }
    const cases::Fields rotated = affine(scene, springs, q);
    for (const auto& stress : rotated.stress) CHECK(matrix_of(stress).norm() <= 1e-13);
  }
}

TEST_CASE("a body far from the origin has the stress that it has there", "[verification]") {
  const cases::Scene here = body();
  cases::Scene there = here;
  for (Vector3d& x : there.mesh.nodes.stored()) x += Vector3d(3e5, -2e5, 1e5); // kept to 6e-11 mm
  const Matrix3d small = Matrix3d::Identity() + 1e-3 * finite_deformation();
  msm::Points displacement;
  for (const Vector3d& x : here.mesh.nodes) displacement.push_back((small - Matrix3d::Identity()) * x);
  const cases::Fields a = msm::fields(here, {bodies::hybrid_cell}, displaced(displacement), 0),
                      b = msm::fields(there, {bodies::hybrid_cell}, displaced(displacement), 0);
  CHECK(largest_difference(a, b) <= 1e-8);
}

TEST_CASE("the reaction of the clamped face is the applied load, whichever path finds the equilibrium",
          "[verification]") {
  const Vector3d force(0.002, -0.001, 0.004);
  cases::Case definition = bodies::clamped_box({4, 4, 5}, {bodies::nodal_force("z+", force)});
  const Vector3d load = 25 * force;
  const auto reaction = [&](const cases::Scene& scene, msm::Path path, double tolerance) {
    const cases::Solution solution = msm::Model(scene, {bodies::hybrid_cell}, {path, 1}).solve();
    const cases::Fields fields = msm::fields(scene, {bodies::hybrid_cell}, solution);
    CHECK((sum(fields.reaction) + load).norm() <= tolerance * load.norm());
    const msm::Lattice lattice = msm::make_lattice(scene.mesh, {bodies::hybrid_cell});
    CHECK(sum(fields.strain_energy) == Approx(msm::energy_at(lattice, solution.displacement)).epsilon(1e-12));
    const msm::Points internal = msm::internal_force_at(lattice, solution.displacement); // forces on points
    Vector3d moment = Vector3d::Zero();
    for (std::size_t n = 0; n < internal.size(); ++n) {
      const Vector3d x = scene.mesh.nodes[n] + solution.displacement[n];
      const bool is_clamped = scene.mesh.nodes[n].z()<1e-9, is_loaded = scene.mesh.nodes[n].z()> 5 - 1e-9;
      CHECK((fields.reaction[n] + (is_clamped ? internal[n] : Vector3d(0, 0, 0))).norm() <=
            1e-12 * load.norm());
      moment += x.cross(Vector3d(fields.reaction[n] + (is_loaded ? force : Vector3d(0, 0, 0))));
    }
    CHECK(moment.norm() <= 10 * tolerance * load.norm() * 5);
  };
  for (const auto path : {msm::Path::direct, msm::Path::multigrid})
    reaction(cases::make_scene(definition), path, 1e-8); // the solvers' 1e-9 of the load
  definition.msm.solver = cases::Solver::fire;
  reaction(cases::make_scene(definition), msm::Path::automatic, 1e-8);
}

TEST_CASE("a pressed body pushes both its plates, each with the other's force", "[verification]") {
  cases::Case definition = bodies::clamped_box({3, 3, 3}, {});
  cases::Moved moved;
  moved.region = bodies::region("z+");
  moved.displacement = {0, 0, -0.3};
  definition.moved = {moved};
  const cases::Scene scene = cases::make_scene(definition);
  const cases::Solution solution = msm::Model(scene, {bodies::hybrid_cell}).solve();
  const cases::Fields fields = msm::fields(scene, {bodies::hybrid_cell}, solution);
  Vector3d above = Vector3d::Zero();
  for (std::size_t n = 0; n < fields.reaction.size(); ++n)
    if (scene.mesh.nodes[n].z() > 3 - 1e-9) above += fields.reaction[n];
  CHECK(above.z() < 0); // the plate pushes down
  CHECK(sum(fields.reaction).norm() <= 1e-8 * above.norm());
}

TEST_CASE("the energy of a small load is half its work", "[verification]") {
  const cases::Scene scene =
      cases::make_scene(bodies::clamped_box({4, 4, 4}, {bodies::nodal_force("z+", {1e-7, 0, 2e-7})}));
  for (const msm::CellStiffness& springs : {bodies::hybrid_cell, power_log_cell()}) {
    const cases::Solution solution = msm::Model(scene, {springs}, {msm::Path::direct, 1}).solve();
    double work = 0;
    for (std::size_t n = 0; n < solution.displacement.size(); ++n)
      if (scene.mesh.nodes[n].z() > 4 - 1e-9) work += solution.displacement[n].dot(Vector3d(1e-7, 0, 2e-7));
    // strains of 1e-5, of which springs keep 1e-11
    CHECK(sum(msm::fields(scene, {springs}, solution).strain_energy) == Approx(work / 2).epsilon(1e-4));
  }
}

TEST_CASE("cells of terms have the stress that is the derivative of their energy", "[verification]") {
  const cases::Scene scene = body();
  const Matrix3d f = finite_deformation();
  const double step = 1e-3; // truncation step⁴ ~ 1e-12, rounding 1e-16/step
  for (const msm::BodyTerms& terms : bodies_of_terms()) {
    const cases::Fields at_f = msm::fields(scene, terms, deformed(scene, f), 0);
    std::vector<Matrix3d> first(at_f.stress.size()); // P = dW/dF of each cell of 1 mm³
    for (int k = 0; k < 9; ++k) {
      const auto energy = [&](double steps) {
        Matrix3d moved = f;
        moved(k / 3, k % 3) += steps * step;
        return msm::fields(scene, terms, deformed(scene, moved), 0).strain_energy;
      };
      const auto one = energy(1), minus_one = energy(-1), two = energy(2), minus_two = energy(-2);
      for (std::size_t c = 0; c < first.size(); ++c)
        first[c](k / 3, k % 3) = (8 * (one[c] - minus_one[c]) - two[c] + minus_two[c]) / (12 * step);
    }
    for (std::size_t c = 0; c < first.size(); ++c) {
      const Matrix3d cauchy = first[c] * f.transpose() / f.determinant();
      CHECK((matrix_of(at_f.stress[c]) - cauchy).norm() <= 1e-9 * cauchy.norm());
    }
  }
}

TEST_CASE("cells of terms have the energy and the forces of their lattice", "[verification]") {
  const cases::Scene scene = body();
  const msm::Points rest(scene.mesh.nodes.size(), Vector3d(0, 0, 0));
  const cases::Solution solution = displaced(bodies::disturbed(rest, 0.1));
  for (const msm::BodyTerms& terms : bodies_of_terms()) {
    const cases::Fields fields = msm::fields(scene, terms, solution, 0);
    const msm::Lattice lattice = msm::make_lattice(scene.mesh, terms);
    CHECK(fields.total_energy == Approx(msm::energy_at(lattice, solution.displacement)).epsilon(1e-12));
    const msm::Points force = msm::internal_force_at(lattice, solution.displacement);
    for (std::size_t n = 0; n < force.size(); ++n)
      if (scene.mesh.nodes[n].z() < 1e-9) CHECK((fields.reaction[n] + force[n]).norm() <= 1e-14);
  }
}

TEST_CASE("a network has reactions, a whole energy and strain, but no stress", "[verification]") {
  const cases::Scene scene = body();
  const cases::Solution solution = deformed(scene, finite_deformation());
  msm::Network springs;
  const msm::Lattice lattice = msm::make_lattice(scene.mesh, {bodies::thesis_cell});
  for (const auto& [i, j, spring] : lattice.links) springs.push_back({j, i, spring.stiffness, {}, {}});
  const cases::Fields of_cells = affine(scene, bodies::thesis_cell, finite_deformation()),
                      of_network = msm::fields(scene, springs, solution, 0);
  CHECK_FALSE(of_network.has_stress);
  CHECK(of_network.stress.empty());
  CHECK(of_network.strain_energy.empty());
  CHECK(of_network.total_energy == Approx(of_cells.total_energy).epsilon(1e-12));
  CHECK(of_network.total_energy > 0);
  for (std::size_t n = 0; n < of_cells.reaction.size(); ++n)
    CHECK((of_network.reaction[n] - of_cells.reaction[n]).norm() <= 1e-14); // N, of about 0.01
  for (std::size_t c = 0; c < of_cells.strain.size(); ++c)
    CHECK((matrix_of(of_network.strain[c]) - matrix_of(of_cells.strain[c])).norm() <= 1e-14);
}

} // namespace stress_of_springs
