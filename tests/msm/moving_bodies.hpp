#pragma once

#include "msm/direct/direct_system.hpp"
#include "msm/grid/moving_grid.hpp"
#include "msm/model.hpp"

#include <Eigen/Geometry>
#include <memory>
#include <random>
#include <string>
#include <utility>

using namespace springproof;

/// Blocks of springs in motion, on the grid path.
namespace moving_bodies {

using Eigen::Vector3d;
using mechanics::Vector;

const msm::CellStiffness hybrid_springs{0.2, 0.1, 0.3, 0.05}; // N/mm, MPa

inline cases::Region region_of(const std::string& name) {
  return {name};
}

inline cases::Load gravity() {
  return {{}, cases::loads::Gravity{{0, 2, -9.81}}};
}

inline cases::Dynamics steps(cases::Scheme scheme, double step, double end) {
  cases::Dynamics dynamics;
  dynamics.scheme.scheme = scheme;
  dynamics.scheme.rho_infinity = 0.8;
  dynamics.step = step;
  dynamics.end = end;
  return dynamics;
}

/// n + 1 by n - 1 by n cells of 10 mm, held at z- unless it flies, under gravity.
inline cases::Case block_case(int n) {
  cases::Case definition;
  definition.body = cases::Box{{10. * (n + 1), 10. * (n - 1), 10. * n}, {n + 1, n - 1, n}};
  definition.fixed.push_back({region_of("z-"), {true, true, true}});
  return definition;
}

inline cases::Scene in_motion(const cases::Case& definition, const cases::Dynamics& dynamics,
                              const cases::MaterialDynamics& material) {
  cases::Scene scene = cases::make_scene(definition);
  scene.definition.material_dynamics = material;
  scene.definition.dynamics = dynamics;
  return scene;
}

/// @param has_holes  every seventh cell is missing
inline cases::Scene block(const cases::Dynamics& dynamics, const cases::MaterialDynamics& material,
                          bool has_holes = false, int n = 5) {
  cases::Scene scene = in_motion(block_case(n), dynamics, material);
  scene.loads.push_back({{}, gravity()});
  if (!has_holes) return scene;
  cases::Grid grid = *scene.mesh.grid;
  for (int c = 0; c < (n + 1) * (n - 1) * n; ++c) grid.present.push_back(c % 7 != 3);
  scene.mesh = cases::make_grid_mesh(grid);
  scene.constrained.front().selection = cases::select(scene.mesh, region_of("z-"));
  return scene;
}

inline cases::Scene with_consistent_masses(cases::Scene scene) {
  scene.definition.msm.mass = cases::PointMass::consistent;
  return scene;
}

/// A block whose lower end is turned and moved along x.
inline cases::Scene turned_block(const cases::Dynamics& dynamics, const cases::MaterialDynamics& material) {
  cases::Case definition = block_case(5);
  definition.fixed.clear();
  cases::Moved moved;
  moved.region = region_of("z-");
  moved.displacement = {1, 0, 0};
  moved.history.points = {{0., 0.}, {0.05, 1.}, {0.1, -1.}};
  definition.moved.push_back(moved);
  moved.region = region_of("z+");
  moved.displacement = Vector3d::Zero();
  moved.angle = 5;
  moved.axis = {0, 0, 1};
  moved.centre = {30, 20, 50};
  definition.moved.push_back(moved);
  return in_motion(definition, dynamics, material);
}

/// A block's springs on the grid path, for steps of one's own.
struct Moving {
  msm::Problem problem;
  msm::grid::GridProblem grid;
  msm::grid::NodeVectors vectors;
  std::unique_ptr<msm::grid::GridSystem> statics;
  std::unique_ptr<msm::MovingSprings> motion;

  Moving(const cases::Scene& scene, const std::vector<msm::CellStiffness>& cells, int n_threads = 1)
      : problem(msm::make_moving_problem(scene)), grid(msm::grid::make_grid_problem(problem, cells)),
        vectors(grid.body), statics(msm::grid::make_grid_system(grid, n_threads)),
        motion(msm::grid::make_moving_grid(problem, grid, vectors, *statics, msm::make_inertia(scene, {}),
                                           *msm::damping_springs(scene, cells).cells(), n_threads)) {}
  Moving(const cases::Scene& scene, const msm::CellStiffness& cell) : Moving(scene, std::vector{cell}) {}
  Moving(const Moving&) = delete; // the others refer to its problem

  Vector rest() const { return Vector::Zero(vectors.size()); }
  Vector vector(const msm::Points& points) const {
    return vectors.from_field(msm::grid::to_field(problem, grid.body, points));
  }
  /// Returns the vector as a field in the layout of statics.
  Vector field(const Vector& vector) const {
    Vector room;
    return vectors.to_field(vector, room);
  }
  msm::Points points(const Vector& vector) const {
    return msm::grid::to_points(problem, grid.body, field(vector));
  }

  /// Random values between -size and size; constrained entries are zero.
  Vector random_motion(double size, unsigned seed) const {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> value(-size, size);
    msm::Points all;
    for (std::size_t p = 0; p < problem.mesh.nodes.size(); ++p) {
      const double x = value(generator), y = value(generator), z = value(generator);
      all.emplace_back(x, y, z);
    }
    Vector field = msm::grid::to_field(problem, grid.body, all);
    msm::grid::clear_constrained(grid.body, field);
    return vectors.from_field(field);
  }
};

} // namespace moving_bodies
