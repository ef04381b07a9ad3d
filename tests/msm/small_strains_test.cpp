// Springs at strains that rounding of positions would hide; finite elements:
// tests/fem_reference/small_strains_test.cpp. Looked at for the same: volume terms, power-log springs, both
// solvers, supports that move, steps in time.

#include "msm/design/design.hpp"
#include "msm/model.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using Eigen::Vector3d;

namespace {

/// A cube of 6 x 6 x 6 cells, free to contract, pulled along z by a traction in small steps of double
/// precision.
cases::Scene pulled_cube(double traction) {
  cases::Case definition = bodies::clamped_box({6, 6, 6}, {});
  definition.fixed.clear();
  for (const char* face : {"x-", "y-", "z-"}) {
    cases::Fixed fixed{bodies::region(face)};
    fixed.components = {face[0] == 'x', face[0] == 'y', face[0] == 'z'};
    definition.fixed.push_back(fixed);
  }
  definition.loads = {{bodies::region("z+"), cases::loads::Traction{{0, 0, traction}}}};
  return cases::make_scene(definition);
}

/// Strains along and across of a solution that is homogeneous to a billionth of the strain along.
struct Strains {
  double along = 0, across = 0, off = 0;
  Strains(const cases::Scene& scene, const cases::Solution& solution) {
    const auto last = solution.displacement.size() - 1; // the far corner, at (6, 6, 6) mm
    along = solution.displacement[last].z() / 6;
    across = solution.displacement[last].x() / 6;
    for (std::size_t n = 0; n <= last; ++n) {
      const Vector3d at = scene.mesh.nodes[n], linear(across * at.x(), across * at.y(), along * at.z());
      off = larger(off, (solution.displacement[n] - linear).norm() / (6 * std::abs(along)));
    }
  }
};

} // namespace

TEST_CASE("springs pulled by strains of 1e-12 to 1e-7 follow their lattice's moduli to a billionth or to the "
          "strain",
          "[verification]") {
  const msm::CellStiffness linear = bodies::cell(120, 60, 0, 0.05);
  msm::CellStiffness power_log = linear;
  power_log.exponents = msm::Exponents{1, 1, 1};
  for (const msm::CellStiffness& cell : {linear, power_log})
    for (const msm::Path path : {msm::Path::direct, msm::Path::multigrid}) {
      msm::ModelOptions options;
      options.path = path;
      const auto strains_under = [&](double traction) {
        const cases::Scene scene = pulled_cube(traction);
        const cases::Solution found = msm::Model(scene, {cell}, options).solve();
        CHECK(found.residual <= 1e-9);
        return Strains(scene, found);
      };
      const double unit = strains_under(1e-13).along / 1e-13; // 1/E
      for (const double strain : {1e-12, 1e-10, 5e-8, 1e-7}) {
        const Strains found = strains_under(strain / unit);
        CAPTURE(static_cast<int>(path), cell.exponents.has_value(), strain);
        CHECK(found.off <= 2e-9);                                        // the solver's tolerance
        CHECK(std::abs(found.along / strain - 1) <= 2e-9 + 10 * strain); // and geometry, to order strain
        CHECK(std::abs(found.across / found.along - strains_under(1e-13).across / (1e-13 * unit)) <=
              2e-9 + 10 * strain);
      }
    }
}

namespace {

/// Strains of a cube's cell whose springs are Hooke's, pulled along z by a traction: Newton's method on
/// differences of lengths that are formed without cancellation.
/// @return strain across and along
Eigen::Vector2d exact_strains(const msm::CellStiffness& cell, double traction) {
  struct Spring {
    double count, stiffness;
    Eigen::Vector2d squares; ///< squared parts across and along, mm2
  };
  const Spring springs[] = {{8, cell.edge, {1, 0}},
                            {4, cell.edge, {0, 1}},
                            {4, cell.face_diagonal, {2, 0}},
                            {8, cell.face_diagonal, {1, 1}},
                            {4, cell.internal_diagonal, {2, 1}}};
  Eigen::Vector2d strain(0, 0);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Eigen::Vector2d stretch = strain.array() + 1,
                          growth = strain.array() * (strain.array() + 2); // stretch^2 - 1
    Eigen::Vector2d force(0, -traction);
    Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero(); // the stiffness at rest
    for (const auto& [count, k, squares] : springs) {
      const double rest = std::sqrt(squares.sum()), length = std::sqrt(squares.sum() + squares.dot(growth));
      const double longer = squares.dot(growth) / (length + rest);
      force += count * k * longer / length * squares.cwiseProduct(stretch);
      stiffness += count * k / (rest * rest) * squares * squares.transpose();
    }
    const Eigen::Vector2d of_volume(2 * stretch[0] * stretch[1], stretch[0] * stretch[0]);
    force += cell.volume * (growth[0] + strain[1] + growth[0] * strain[1]) * of_volume;
    stiffness += cell.volume * Eigen::Vector2d(2, 1) * Eigen::RowVector2d(2, 1);
    strain -= stiffness.ldlt().solve(force);
  }
  return strain;
}

} // namespace

TEST_CASE(
    "Hooke's springs pulled by strains of 1e-12 to 1e-3 follow their cell's exact answer to a billionth",
    "[verification]") {
  const msm::CellStiffness cell = bodies::cell(120, 60, 0, 0.05);
  const double young = 1e-6 / exact_strains(cell, 1e-6)[1];
  for (const msm::Path path : {msm::Path::direct, msm::Path::multigrid})
    for (const double strain : {1e-12, 1e-9, 1e-7, 3e-6, 1e-5, 1e-4, 1e-3}) {
      CAPTURE(static_cast<int>(path), strain);
      msm::ModelOptions options;
      options.path = path;
      const cases::Scene scene = pulled_cube(strain * young);
      const Strains found(scene, msm::Model(scene, {cell}, options).solve());
      const Eigen::Vector2d exact = exact_strains(cell, strain * young);
      CHECK(found.off <= 2e-9); // the solver's
      CHECK(std::abs(found.across / exact[0] - 1) <= 2e-9);
      CHECK(std::abs(found.along / exact[1] - 1) <= 2e-9);
    }
}
