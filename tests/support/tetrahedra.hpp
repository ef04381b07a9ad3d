#pragma once

#include "cases/mesh/mesh.hpp"

namespace bodies {

namespace cases = springproof::cases;

/// A box of cubes, each cut into six tetrahedra around its diagonal, and sheared so that no edge is as long
/// as another.
inline cases::Mesh box_of_tetrahedra(const std::array<int, 3>& n_cubes) {
  const cases::Mesh box =
      cases::make_box_mesh({double(n_cubes[0]), double(n_cubes[1]), double(n_cubes[2])}, n_cubes);
  cases::Mesh mesh;
  mesh.shape = cases::CellShape::tetrahedron;
  for (const Eigen::Vector3d& node : box.nodes)
    mesh.nodes.stored().emplace_back(node.x() + 0.2 * node.y(), node.y() - 0.1 * node.z(), 1.3 * node.z());
  for (const cases::CellNodes& cube : box.cells)
    for (const auto& [a, b] : {std::pair(1, 3), {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}})
      mesh.cells.stored().push_back(cases::pick(cube, cases::CellNodes{0, a, b, 7}));
  return mesh;
}

} // namespace bodies
