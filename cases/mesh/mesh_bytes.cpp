#include "cases/mesh/mesh_bytes.hpp"

#include "cases/mesh/fields.hpp"

#include <stdexcept>

namespace springproof::cases {

namespace {

/// @throws std::runtime_error if an index leads out of the mesh's arrays, or a position is not finite
void check(const HexMesh& mesh) {
  const auto exist = [n_nodes = mesh.nodes.size()](const auto& nodes) {
    return std::all_of(nodes.begin(), nodes.end(),
                       [&](int node) { return node >= 0 && index(node) < n_nodes; });
  };
  const auto all_exist = [&](const auto& lists) { return std::all_of(lists.begin(), lists.end(), exist); };
  bool is_sound = !mesh.cells.empty() && all_exist(mesh.cells) &&
                  (mesh.group_of_cell.empty() || mesh.group_of_cell.size() == mesh.cells.size()) &&
                  std::all_of(mesh.nodes.begin(), mesh.nodes.end(),
                              [](const Eigen::Vector3d& node) { return node.allFinite(); });
  for (const auto& [name, group] : mesh.groups)
    is_sound = is_sound && exist(group.nodes) && all_exist(group.edges) && all_exist(group.faces);
  if (!is_sound) throw std::runtime_error("is no sound mesh");
}

} // namespace

std::string bytes_of_mesh(const HexMesh& mesh) {
  return to_bytes(mesh.nodes.to_vector(), mesh.cells.to_vector(), mesh.groups, mesh.group_of_cell);
}

HexMesh mesh_from(const std::string& bytes) {
  HexMesh mesh;
  from_bytes(bytes, mesh.nodes.stored(), mesh.cells.stored(), mesh.groups, mesh.group_of_cell);
  check(mesh);
  find_grid(mesh);
  return mesh;
}

} // namespace springproof::cases
