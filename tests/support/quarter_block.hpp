#pragma once

#include "cases/scene/scene.hpp"

#include <vector>

using namespace springproof;

/// Quarters of blocks that a tool presses on their tops, for tests of contact.
namespace quarter_block {

/// Cells of one size from 0 on, and beyond them each so many times as long as the last.
struct Grading {
  double size;   ///< mm, of the first cells
  int n_equal;   ///< how many are of that size
  int n_growing; ///< how many follow
  double growth; ///< 1: all are equal

  /// Places of the nodes, from 0.
  std::vector<double> places() const {
    std::vector<double> all{0};
    double length = size;
    for (int i = 0; i < n_equal + n_growing; ++i) {
      if (i >= n_equal) length *= growth;
      all.push_back(all.back() + length);
    }
    return all;
  }
};

/// A quarter of a block with its top at z = 0, clamped below, with planes of symmetry at x = 0 and y = 0 and
/// free sides: cells grow away from the origin.
inline cases::Scene make(cases::Case definition, const Grading& grading) {
  const std::vector<double> places = grading.places();
  const int n = static_cast<int>(places.size()) - 1;
  const double size = places.back();
  definition.name = "block";
  definition.body = cases::Box{{size, size, size}, {n, n, n}};
  definition.fixed = {{{"z-"}}};
  definition.symmetry = {{{"x-"}, {true, false, false}}, {{"y-"}, {false, true, false}}};
  cases::Scene scene = cases::make_scene(definition);
  std::vector<Eigen::Vector3d> nodes;
  for (int k = n; k >= 0; --k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const auto at = [&](int place) { return places[static_cast<std::size_t>(place)]; };
        nodes.emplace_back(at(i), at(j), -at(k));
      }
  std::vector<cases::CellNodes> cells;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) cells.push_back(scene.mesh.cells[c]);
  scene.mesh.nodes = nodes;
  scene.mesh.cells = cells;
  scene.mesh.grid.reset();
  return scene;
}

/// A tool above the origin that goes down by so much.
inline cases::Tool pressed_down(const cases::tools::Kind& shape, const Eigen::Vector3d& at, double by) {
  cases::Tool tool;
  tool.name = "tool";
  tool.shape = shape;
  tool.at = at;
  tool.displacement = {0, 0, -by};
  return tool;
}

} // namespace quarter_block
