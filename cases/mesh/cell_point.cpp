#include "cases/mesh/cell_point.hpp"

#include "mechanics/hexahedron.hpp"

#include <map>

namespace springproof::cases {

std::array<double, 8> weights_at(const CellPoint& point) {
  std::array<double, 8> weights = mechanics::shape_values(point.at);
  const Eigen::Matrix<double, 3, 8> gradients = mechanics::shape_gradients(point.at);
  for (int v = 0; v < 8; ++v) weights[index(v)] += gradients.col(v).dot(point.beyond);
  return weights;
}

CellPoint refine(const CellPoint& point) {
  CellPoint fine{8 * point.cell, 2 * point.at, 2 * point.beyond};
  for (int axis = 0; axis < 3; ++axis)
    if (point.at[axis] >= 0.5) { // child i + 2j + 4k is at (i, j, k)
      fine.cell += std::size_t{1} << axis;
      fine.at[axis] -= 1;
    }
  return fine;
}

std::vector<NodeWeight> on_nodes(const std::vector<WeightedPoint>& points, const HexMesh& mesh) {
  std::map<int, double> weight; // of nodes
  for (const auto& [point, part] : points) {
    const std::array<int, 8> nodes = mesh.cells[point.cell];
    const std::array<double, 8> weights = weights_at(point);
    for (std::size_t n = 0; n < nodes.size(); ++n) weight[nodes[n]] += part * weights[n];
  }
  std::vector<NodeWeight> weights;
  for (const auto& [node, share] : weight)
    if (share != 0) weights.push_back({node, share});
  return weights;
}

} // namespace springproof::cases
