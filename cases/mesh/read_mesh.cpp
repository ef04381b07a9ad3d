#include "cases/mesh/read_mesh.hpp"

#include "cases/case/index.hpp"
#include "cases/mesh/confined.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/mesh/find_grid.hpp"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gmsh.h>
#include <map>
#include <numeric>
#include <unordered_map>

namespace springproof::cases {

namespace {

/// For gmsh to mesh a geometry.
constexpr int most_seconds = 600;

using Tags = std::vector<std::size_t>;

/// gmsh's numbers of element types.
enum GmshType { line = 1, quadrangle = 3, hexahedron = 5, point = 15 };

/// gmsh's vertices of a hexahedron go around its bottom, then around its top; ours are numbered i + 2j + 4k.
constexpr std::array<std::size_t, 8> gmsh_vertex{0, 1, 3, 2, 4, 5, 7, 6};

/// Elements of one type on one entity or dimension, node tags one element after another.
struct Elements {
  int type;
  Tags tags, nodes;
  std::size_t nodes_each() const { return nodes.size() / tags.size(); }
};

std::vector<Elements> elements_of(int dimension, int entity) {
  std::vector<int> types;
  std::vector<Tags> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
  std::vector<Elements> elements;
  for (std::size_t t = 0; t < types.size(); ++t)
    if (!tags[t].empty()) elements.push_back({types[t], tags[t], nodes[t]});
  return elements;
}

std::string type_name(int type) {
  std::string name;
  int dimension, order, n_nodes, n_primary;
  std::vector<double> local;
  gmsh::model::mesh::getElementProperties(type, name, dimension, order, n_nodes, local, n_primary);
  return name;
}

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
  void read_cells();
  void read_nodes();
  void check_cells() const;
  void check_in_one_piece() const;
  void read_groups();
  void add_to_group(const std::string& name, Selection& group, const Elements& elements);
  int node_of(std::size_t tag) const {
    const auto found = node_number_.find(tag);
    return found == node_number_.end() ? -1 : found->second;
  }

  HexMesh mesh_;
  Tags cell_tags_;
  std::unordered_map<std::size_t, int> node_number_; ///< by gmsh's tag; nodes of hexahedra only
  std::unordered_map<std::size_t, std::size_t> cell_number_;
  std::map<std::array<int, 4>, std::array<int, 4>>
      faces_; ///< by sorted vertices, as seen from outside of one of their cells
};

/// All three-dimensional elements, their nodes by gmsh's tags for the moment.
void Builder::read_cells() {
  std::string others;
  for (const Elements& elements : elements_of(3, -1)) {
    if (elements.type != hexahedron) {
      others += fmt::format("{}{} of type {}", others.empty() ? "" : ", ", elements.tags.size(),
                            type_name(elements.type));
      continue;
    }
    for (std::size_t e = 0; e < elements.tags.size(); ++e) {
      cell_number_[elements.tags[e]] = mesh_.cells.size();
      cell_tags_.push_back(elements.tags[e]);
      std::array<int, 8> cell{};
      for (std::size_t v = 0; v < 8; ++v) {
        const std::size_t tag = elements.nodes[8 * e + gmsh_vertex[v]];
        if (tag > 2147483647) refuse(fmt::format("has a node of number {}, must be below 2^31", tag));
        cell[v] = static_cast<int>(tag);
      }
      mesh_.cells.push_back(cell);
    }
  }
  if (!others.empty()) refuse("has cells other than eight-node hexahedra: " + others);
  if (mesh_.cells.empty()) refuse("has no hexahedra");
}

void Builder::read_nodes() {
  Tags tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, -1, -1, false, false);
  std::unordered_map<std::size_t, std::size_t> place;
  for (std::size_t n = 0; n < tags.size(); ++n) place[tags[n]] = n;
  std::vector<int> used;
  for (const auto& cell : mesh_.cells) used.insert(used.end(), cell.begin(), cell.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const int tag : used) {
    const auto found = place.find(index(tag));
    if (found == place.end()) refuse(fmt::format("has a hexahedron with node {}, which does not exist", tag));
    node_number_[index(tag)] = static_cast<int>(mesh_.nodes.size());
    const double* at = &coordinates[3 * found->second];
    mesh_.nodes.emplace_back(at[0], at[1], at[2]);
  }
  for (auto& cell : mesh_.cells)
    for (int& node : cell) node = node_number_[index(node)];
}

/// The Jacobian is positive at every corner of a cell that is neither inside out nor folded.
void Builder::check_cells() const {
  std::vector<std::size_t> inverted;
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
    if (!(smallest_corner_jacobian(cell_vertices(mesh_, c)) > 0)) inverted.push_back(cell_tags_[c]);
  if (inverted.empty()) return;
  constexpr std::size_t n_shown = 5;
  std::string which;
  for (std::size_t i = 0; i < std::min(n_shown, inverted.size()); ++i)
    which += fmt::format(" {}", inverted[i]);
  refuse(fmt::format(
      "{} of {} hexahedra are inverted or degenerate (a corner whose Jacobian is not positive): elements{}{}",
      inverted.size(), mesh_.cells.size(), which, inverted.size() > n_shown ? " ..." : ""));
}

/// A piece that shares no node with the rest is unconstrained: most often coincident nodes were not merged.
void Builder::check_in_one_piece() const {
  std::vector<int> root(mesh_.nodes.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int n) {
    while (root[index(n)] != n) n = root[index(n)] = root[index(root[index(n)])];
    return n;
  };
  std::size_t n_pieces = mesh_.nodes.size();
  for (const auto& cell : mesh_.cells)
    for (const int node : cell) {
      const int a = find(cell[0]), b = find(node);
      if (a == b) continue;
      root[index(b)] = a;
      --n_pieces;
    }
  if (n_pieces != 1)
    refuse(fmt::format(
        "falls into {} pieces that share no node; where they touch, merge their nodes (gmsh: Coherence Mesh)",
        n_pieces));
}

void Builder::read_groups() {
  for (const auto& cell : mesh_.cells)
    for (const auto& local : cell_faces) {
      std::array<int, 4> face{}, sorted{};
      for (std::size_t v = 0; v < 4; ++v) face[v] = sorted[v] = cell[index(local[v])];
      std::sort(sorted.begin(), sorted.end());
      faces_.emplace(sorted, face);
    }
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dimension, tag] : groups) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, tag, name);
    if (name.empty()) name = std::to_string(tag);
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, entities);
    for (const int entity : entities)
      for (const Elements& elements : elements_of(dimension, entity))
        add_to_group(name, mesh_.groups[name], elements);
  }
  for (auto& entry : mesh_.groups) {
    const auto make_set = [](auto& list) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    make_set(entry.second.nodes);
    make_set(entry.second.edges);
    make_set(entry.second.faces);
  }
}

void Builder::add_to_group(const std::string& name, Selection& group, const Elements& elements) {
  const auto add_edge = [&](int a, int b) { group.edges.push_back({std::min(a, b), std::max(a, b)}); };
  for (std::size_t e = 0; e < elements.tags.size(); ++e) {
    std::vector<int> nodes;
    for (std::size_t v = 0; v < elements.nodes_each(); ++v)
      nodes.push_back(node_of(elements.nodes[e * elements.nodes_each() + v]));
    // Points and lines of the geometry may lie off the body; a group's surface must not.
    const bool is_off = std::count(nodes.begin(), nodes.end(), -1) > 0;
    if (is_off && (elements.type == point || elements.type == line)) continue;
    if (elements.type == line) add_edge(nodes[0], nodes[1]);
    if (elements.type == quadrangle) {
      std::array<int, 4> sorted{nodes[0], nodes[1], nodes[2], nodes[3]};
      std::sort(sorted.begin(), sorted.end());
      const auto face = faces_.find(sorted);
      if (face == faces_.end())
        refuse(fmt::format("element {} of group '{}' is no face of a hexahedron", elements.tags[e], name));
      group.faces.push_back(face->second);
      for (std::size_t v = 0; v < 4; ++v) add_edge(face->second[v], face->second[(v + 1) % 4]);
    } else if (elements.type == hexahedron) {
      mesh_.group_of_cell.resize(mesh_.cells.size());
      mesh_.group_of_cell[cell_number_.at(elements.tags[e])] = name;
    } else if (elements.type != point && elements.type != line) {
      refuse(fmt::format("group '{}' has elements of type {}, which are no part of a hexahedron", name,
                         type_name(elements.type)));
    }
    group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
  }
}

/// gmsh reads every format it ever wrote; older ones lose the entities of groups.
void check_format(const std::string& path) {
  std::ifstream stream(path);
  std::string heading;
  double version = 0;
  if (!stream) refuse("cannot be read");
  if (!(stream >> heading >> version) || heading != "$MeshFormat")
    refuse("is not a gmsh mesh, which begins with $MeshFormat and its version");
  if (!(version >= 4 && version < 5))
    refuse(fmt::format("has format {}, must be 4 or 4.1 (gmsh -save -format msh41 rewrites it)", version));
}

/// The file in gmsh, quiet, without configuration files. gmsh would also run a script NAME.msh.opt beside a
/// mesh; a mesh is therefore opened by its descriptor, beside which there is none.
void open_in_gmsh(const std::string& path, bool is_geometry) {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  if (is_geometry) {
    gmsh::open(path);
    gmsh::model::mesh::generate(3);
  } else {
    gmsh::open(fmt::format("/proc/self/fd/{}", open(path.c_str(), O_RDONLY)));
  }
}

/// The mesh of a file, as bytes.
std::string mesh_bytes(const std::string& path, bool is_geometry) {
  if (!is_geometry) check_format(path);
  try {
    open_in_gmsh(path, is_geometry);
    return to_bytes(Builder().build());
  } catch (const std::string& reason) { // gmsh throws its messages
    refuse("gmsh: " + reason);
  }
}

} // namespace

HexMesh read_mesh(const MeshFile& file) {
  const std::filesystem::path path(file.path);
  if (!std::filesystem::is_regular_file(path))
    throw InputError(file.where, file.path + ": there is no such file");
  const bool is_geometry = path.extension() == ".geo";
  // A .geo is a program, and gmsh crashes on some broken meshes.
  const auto confined = [&] {
    try {
      return run_confined([&] { return mesh_bytes(file.path, is_geometry); }, most_seconds);
    } catch (const std::runtime_error& error) {
      throw InputError(file.where, fmt::format("{}: {}", file.path, error.what()));
    }
  };
  HexMesh mesh;
  from_bytes(confined(), mesh);
  find_grid(mesh);
  return mesh;
}

} // namespace springproof::cases
