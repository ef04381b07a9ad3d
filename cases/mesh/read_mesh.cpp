#include "cases/mesh/read_mesh.hpp"

#include "cases/mesh/confined.hpp"
#include "cases/mesh/gmsh.hpp"
#include "cases/mesh/mesh_bytes.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <numeric>
#include <unordered_map>

namespace springproof::cases {

namespace {

/// For gmsh to mesh a geometry, however short its text.
constexpr Limits limits_to_mesh{600, 8'000'000'000};

[[noreturn]] void refuse(const std::string& reason) {
  throw std::runtime_error(reason);
}

/// Makes the mesh of gmsh's model, and remembers which node and cell is which of gmsh's.
class Builder {
 public:
  HexMesh build() {
    read_cells();
    read_nodes();
    check_cells();
    check_in_one_piece();
    read_groups();
    return std::move(mesh_);
  }

 private:
  /// All three-dimensional elements, their nodes by gmsh's tags for the moment.
  void read_cells() {
    std::vector<std::string> others;
    for (const GmshElements& elements : gmsh().elements_of(3, -1)) {
      if (elements.type != hexahedron) {
        others.push_back(fmt::format("{} of type {}", elements.tags.size(), gmsh().type_name(elements.type)));
        continue;
      }
      for (std::size_t e = 0; e < elements.tags.size(); ++e) {
        cell_number_[elements.tags[e]] = mesh_.cells.size();
        cell_tags_.push_back(elements.tags[e]);
        std::array<int, 8>& cell = mesh_.cells.stored().emplace_back();
        for (std::size_t v = 0; v < 8; ++v) {
          const std::size_t tag = elements.nodes[e][around_cell[v]];
          if (tag > 2147483647) refuse(fmt::format("has a node of number {}, must be below 2^31", tag));
          cell[v] = static_cast<int>(tag);
        }
      }
    }
    if (!others.empty())
      refuse(fmt::format("has cells other than eight-node hexahedra: {}", fmt::join(others, ", ")));
    if (mesh_.cells.empty()) refuse("has no hexahedra");
  }

  /// The nodes that hexahedra have, in the order of their tags.
  void read_nodes() {
    const auto [tags, coordinates] = gmsh().nodes();
    std::unordered_map<std::size_t, std::size_t> place;
    for (std::size_t n = 0; n < tags.size(); ++n) place[tags[n]] = n;
    std::vector<int> used;
    for (const auto& cell : mesh_.cells) used.insert(used.end(), cell.begin(), cell.end());
    make_set(used);
    for (const int tag : used) {
      const auto found = place.find(index(tag));
      if (found == place.end())
        refuse(fmt::format("has a hexahedron with node {}, which does not exist", tag));
      node_number_[index(tag)] = static_cast<int>(mesh_.nodes.size());
      mesh_.nodes.stored().emplace_back(&coordinates[3 * found->second]);
    }
    for (auto& cell : mesh_.cells.stored())
      for (int& node : cell) node = node_number_[index(node)];
  }

  /// The Jacobian is positive at every corner of a cell that is neither inside out nor folded.
  void check_cells() const {
    Tags inverted;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      if (!(smallest_corner_jacobian(cell_vertices(mesh_, c)) > 0)) inverted.push_back(cell_tags_[c]);
    if (inverted.empty()) return;
    const std::size_t n_shown = std::min<std::size_t>(5, inverted.size());
    refuse(fmt::format(
        "{} of {} hexahedra are inverted or degenerate (a corner whose Jacobian is not positive): "
        "elements {}{}",
        inverted.size(), mesh_.cells.size(), fmt::join(inverted.data(), inverted.data() + n_shown, " "),
        inverted.size() > n_shown ? " ..." : ""));
  }

  /// A piece that shares no node with the rest is unconstrained: most often coincident nodes were not merged.
  void check_in_one_piece() const {
    std::vector<int> root(mesh_.nodes.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int n) {
      while (root[index(n)] != n) n = root[index(n)] = root[index(root[index(n)])];
      return n;
    };
    for (const auto& cell : mesh_.cells)
      for (const int node : cell) root[index(find(node))] = find(cell[0]);
    int n_pieces = 0;
    for (std::size_t n = 0; n < root.size(); ++n) n_pieces += index(root[n]) == n;
    if (n_pieces != 1)
      refuse(
          fmt::format("falls into {} pieces that share no node; where they touch, merge their nodes (gmsh: "
                      "Coherence Mesh)",
                      n_pieces));
  }

  void read_groups() {
    for (const auto& cell : mesh_.cells)
      for (const auto& local : cell_faces) {
        const std::array<int, 4> face = pick(cell, local);
        faces_.emplace(sorted(face), face);
      }
    for (const GmshGroup& group : gmsh().groups())
      for (const int entity : group.entities)
        for (const GmshElements& elements : gmsh().elements_of(group.dimension, entity))
          add_to_group(group.name.empty() ? std::to_string(group.number) : group.name, elements);
    for (auto& [name, group] : mesh_.groups) {
      make_set(group.nodes);
      make_set(group.edges);
      make_set(group.faces);
    }
  }

  void add_to_group(const std::string& name, const GmshElements& elements) {
    Selection& group = mesh_.groups[name];
    for (std::size_t e = 0; e < elements.tags.size(); ++e) {
      std::vector<int> nodes; // -1: of no hexahedron
      for (const std::size_t tag : elements.nodes[e])
        nodes.push_back(node_number_.count(tag) > 0 ? node_number_[tag] : -1);
      // Points and lines of the geometry may lie off the body; a group's surface must not.
      const bool is_off = std::count(nodes.begin(), nodes.end(), -1) > 0;
      if (is_off && (elements.type == point || elements.type == line)) continue;
      if (elements.type == line) {
        group.edges.push_back(sorted(std::array<int, 2>{nodes[0], nodes[1]}));
      } else if (elements.type == quadrangle) {
        const auto found = faces_.find(sorted(std::array<int, 4>{nodes[0], nodes[1], nodes[2], nodes[3]}));
        if (found == faces_.end())
          refuse(fmt::format("element {} of group '{}' is no face of a hexahedron", elements.tags[e], name));
        const std::array<int, 4>& face = found->second;
        group.faces.push_back(face);
        for (std::size_t v = 0; v < 4; ++v)
          group.edges.push_back(sorted(std::array<int, 2>{face[v], face[(v + 1) % 4]}));
      } else if (elements.type == hexahedron) {
        mesh_.group_of_cell.resize(mesh_.cells.size());
        mesh_.group_of_cell[cell_number_.at(elements.tags[e])] = name;
      } else if (elements.type != point) {
        refuse(fmt::format("group '{}' has elements of type {}, which are no part of a hexahedron", name,
                           gmsh().type_name(elements.type)));
      }
      group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
    }
  }

  HexMesh mesh_;
  Tags cell_tags_;
  std::unordered_map<std::size_t, int> node_number_; ///< by gmsh's tag; nodes of hexahedra only
  std::unordered_map<std::size_t, std::size_t> cell_number_;
  std::map<std::array<int, 4>, std::array<int, 4>>
      faces_; ///< by sorted vertices, as seen from outside of one of their cells
};

/// gmsh reads every format it ever wrote; older ones lose the entities of groups.
void check_format(std::istream& stream) {
  std::string heading;
  double version = 0;
  if (!(stream >> heading >> version) || heading != "$MeshFormat")
    refuse("is not a gmsh mesh, which begins with $MeshFormat and its version");
  if (!(version >= 4 && version < 5))
    refuse(fmt::format("has format {}, must be 4 or 4.1 (gmsh -save -format msh41 rewrites it)", version));
}

/// The mesh of a file, as bytes.
std::string mesh_bytes(const std::string& path, bool is_geometry) {
  std::ifstream stream(path);
  if (!stream) refuse(std::string("cannot be read: ") + std::strerror(errno));
  if (!is_geometry) check_format(stream);
  gmsh().open(path, is_geometry);
  return bytes_of_mesh(Builder().build());
}

} // namespace

HexMesh read_mesh(const MeshFile& file) {
  std::error_code absent;
  if (!std::filesystem::is_regular_file(file.path, absent))
    throw InputError(file.where, file.path + ": " + (absent ? absent.message() : "is no regular file"));
  const bool is_geometry = std::filesystem::path(file.path).extension() == ".geo";
  if (is_geometry && std::filesystem::exists(file.path + ".opt", absent))
    throw InputError(file.where, file.path + ": has options for gmsh beside it, " + file.path +
                                     ".opt: write them into the .geo (Mesh.X = ...;)");
  try {     // A .geo is a program, gmsh crashes on some broken meshes, and its answer may be anything.
    gmsh(); // loaded before the child is confined
    const Limits limits =
        is_geometry ? limits_to_mesh : limits_to_read(std::filesystem::file_size(file.path));
    return mesh_from(run_confined([&] { return mesh_bytes(file.path, is_geometry); }, limits));
  } catch (const std::exception& error) {
    throw InputError(file.where, fmt::format("{}: {}", file.path, error.what()));
  }
}

} // namespace springproof::cases
