#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "msm/spring_body.hpp"
#include "tests/support/largest.hpp"

#include <random>
#include <vector>

using namespace springproof;

/// Bodies and loads that several tests use.
namespace bodies {

inline cases::Region region(const std::string& name) {
  return {name};
}

inline cases::Load nodal_force(const std::string& where, const Eigen::Vector3d& newtons) {
  return {region(where), cases::loads::NodalForce{newtons}};
}

/// A box of cubes of 1 mm, its face z- clamped.
inline cases::Case clamped_box(const std::array<int, 3>& cells, std::vector<cases::Load> loads) {
  cases::Case box;
  box.name = "box";
  box.body = cases::Box{{double(cells[0]), double(cells[1]), double(cells[2])}, cells};
  box.material = cases::LinearElastic{0.3, 0.35};
  box.fixed = {{region("z-")}};
  box.loads = std::move(loads);
  return box;
}

/// Thesis section 4.3: the cube's three load cases, N per node.
inline std::vector<cases::Load> tensile(double f) {
  return {nodal_force("z+", {0, 0, f})};
}
inline std::vector<cases::Load> shear(double f) {
  return {nodal_force("z+", {f, 0, 0})};
}
inline std::vector<cases::Load> torsion(double f) {
  return {nodal_force("z+ y-", {f, 0, 0}), nodal_force("z+ x+", {0, f, 0}), nodal_force("z+ y+", {-f, 0, 0}),
          nodal_force("z+ x-", {0, -f, 0})};
}

/// k_e, k_f, k_d in N/m as the thesis prints them, k_v in MPa.
inline msm::CellStiffness cell(double edge, double face, double internal, double volume = 0) {
  return {1e-3 * edge, 1e-3 * face, 1e-3 * internal, volume};
}

/// Brain tissue's Ogden set in the thesis (section 5.3.1), MPa.
inline const cases::Ogden thesis_ogden = {
    {0.01444, 0.01444, 0.01444}, {5.7255, 5.7255, 5.7255}, std::nullopt};

/// Springs that the thesis prints, and a weaker set with a volume term.
inline const msm::CellStiffness thesis_cell = cell(31, 47, 33), hybrid_cell = cell(20, 25, 20, 0.14);

/// Four of eight cells of a 2x2x2 grid: an edge and a face of some cells lie inside, others outside.
inline cases::Grid masked_grid() {
  cases::Grid grid;
  grid.cells = {2, 2, 2};
  grid.present = {true, true, true, false, false, true, false, false};
  return grid;
}

inline msm::Lattice masked_lattice(const std::optional<msm::Exponents>& exponents = {}) {
  msm::CellStiffness springs = cell(31, 47, 33, 0.14);
  springs.exponents = exponents;
  return msm::make_lattice(cases::make_grid_mesh(masked_grid()), {springs});
}

/// Points moved by up to `size` mm, the same ones in every run.
inline msm::Points disturbed(msm::Points points, double size) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> any(-size, size);
  for (Eigen::Vector3d& point : points)
    point += Eigen::Vector3d(any(generator), any(generator), any(generator));
  return points;
}

} // namespace bodies
