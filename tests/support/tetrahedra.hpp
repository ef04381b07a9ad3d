#pragma once

#include "cases/mesh/mesh.hpp"

namespace bodies {

namespace cases = springproof::cases;

/// A mesh whose hexahedra are each cut into six tetrahedra around their diagonal. Those of neighbours meet in
/// whole faces where cells are numbered along the axes alike. Nodes keep their numbers.
inline cases::Mesh cut_in_tetrahedra(const cases::Mesh& hexahedra) {
  cases::Mesh mesh;
  mesh.shape = cases::CellShape::tetrahedron;
  mesh.nodes = hexahedra.nodes.to_vector();
  for (const cases::CellNodes& cell : hexahedra.cells)
    for (const auto& [a, b] : {std::pair(1, 3), {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}})
      mesh.cells.stored().push_back(cases::pick(cell, cases::CellNodes{0, a, b, 7}));
  return mesh;
}

/// A box of cubes, each cut into six tetrahedra, and sheared so that no edge is as long as another.
inline cases::Mesh box_of_tetrahedra(const std::array<int, 3>& n_cubes) {
  cases::Mesh mesh = cut_in_tetrahedra(
      cases::make_box_mesh({double(n_cubes[0]), double(n_cubes[1]), double(n_cubes[2])}, n_cubes));
  for (Eigen::Vector3d& node : mesh.nodes.stored())
    node = {node.x() + 0.2 * node.y(), node.y() - 0.1 * node.z(), 1.3 * node.z()};
  return mesh;
}

} // namespace bodies
