#include "cases/mesh/read_mesh.hpp"

#include "cases/case/installation.hpp"
#include "cases/mesh/confined.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/mesh/gmsh_model.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
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
  explicit Builder(const GmshModel& model) : model_(model) {}

  Mesh build() {
    read_cells();
    read_nodes();
    faces_ = faces_of_cells(mesh_);
    check_mesh(mesh_, faces_, numbers_);
    read_groups();
    return std::move(mesh_);
  }

 private:
  /// All three-dimensional elements, their nodes by gmsh's tags for the moment.
  void read_cells() {
    std::map<int, std::size_t> others; // numbers of elements by type
    for (const auto& [place, of_entity] : model_.elements)
      for (const GmshElements& elements : of_entity)
        if (place[0] == 3 && elements.type == hexahedron)
          add_cells(elements);
        else if (place[0] == 3)
          others[elements.type] += elements.tags.size();
    std::vector<std::string> shown;
    for (const auto& [type, n] : others)
      shown.push_back(fmt::format("{} of type {}", n, model_.type_names.at(type)));
    if (!shown.empty())
      refuse(fmt::format("has cells other than eight-node hexahedra: {}", fmt::join(shown, ", ")));
    if (mesh_.cells.empty())
      refuse("has no hexahedra. A file that gmsh has saved has its physical groups alone, where there are "
             "any: one of them must be the body, Physical Volume(\"body\") = {...};, or Mesh.SaveAll must be "
             "1. A geometry needs a volume that is meshed by hexahedra (Transfinite or extruded, and "
             "Recombine)");
  }

  void add_cells(const GmshElements& elements) {
    for (std::size_t e = 0; e < elements.tags.size(); ++e) {
      cell_number_[elements.tags[e]] = mesh_.cells.size();
      numbers_.of_cells.push_back(elements.tags[e]);
      CellNodes& cell = mesh_.cells.stored().emplace_back();
      for (std::size_t v = 0; v < 8; ++v) {
        const std::size_t tag = elements.nodes[8 * e + around_cell[v]];
        if (tag > 2147483647) refuse(fmt::format("has a node of number {}, must be below 2^31", tag));
        cell.push_back(static_cast<int>(tag));
      }
    }
  }

  /// The nodes that hexahedra have, in the order of their tags.
  void read_nodes() {
    std::unordered_map<std::size_t, std::size_t> place;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) place[model_.nodes[n]] = n;
    std::vector<int> used;
    for (const auto& cell : mesh_.cells) used.insert(used.end(), cell.begin(), cell.end());
    make_set(used);
    for (const int tag : used) {
      const auto found = place.find(index(tag));
      if (found == place.end())
        refuse(fmt::format("has a hexahedron with node {}, which does not exist", tag));
      node_number_[index(tag)] = static_cast<int>(mesh_.nodes.size());
      numbers_.of_nodes.push_back(index(tag));
      mesh_.nodes.stored().emplace_back(&model_.coordinates[3 * found->second]);
    }
    for (auto& cell : mesh_.cells.stored())
      for (int& node : cell) node = node_number_[index(node)];
  }

  void read_groups() {
    std::map<std::string, std::map<int, Selection>> by_name; // and dimension
    for (const GmshGroup& group : model_.groups) {
      const std::string name = group.name.empty() ? std::to_string(group.number) : group.name;
      for (const int entity : group.entities)
        for (const GmshElements& elements : model_.elements.at({group.dimension, entity}))
          add_to_group(name, elements, by_name[name][group.dimension]);
    }
    for (auto& [name, of_dimensions] : by_name) {
      for (auto& entry : of_dimensions) make_set(entry.second.nodes);
      const bool is_one = are_one_region(of_dimensions);
      for (auto& [dimension, part] : of_dimensions) {
        if (!is_one && dimension == 3) continue; // in group_of_cell
        Selection& group = mesh_.groups[is_one ? name : name_in_dimension(name, dimension)];
        group.nodes.insert(group.nodes.end(), part.nodes.begin(), part.nodes.end());
        group.edges.insert(group.edges.end(), part.edges.begin(), part.edges.end());
        group.faces.insert(group.faces.end(), part.faces.begin(), part.faces.end());
      }
    }
    for (auto& entry : mesh_.groups) {
      make_set(entry.second.nodes);
      make_set(entry.second.edges);
      make_set(entry.second.faces);
    }
  }

  /// Points and curves that lie in a surface of the same name change nothing of what it holds or loads; a
  /// volume holds far more than its surface.
  static bool are_one_region(const std::map<int, Selection>& of_dimensions) {
    const auto& [highest, largest] = *of_dimensions.rbegin();
    if (highest == 3)
      return std::all_of(of_dimensions.begin(), std::prev(of_dimensions.end()),
                         [](const auto& entry) { return entry.second.nodes.empty(); });
    return std::all_of(of_dimensions.begin(), of_dimensions.end(),
                       [&nodes = largest.nodes](const auto& entry) {
                         const std::vector<int>& some = entry.second.nodes;
                         return std::includes(nodes.begin(), nodes.end(), some.begin(), some.end());
                       });
  }

  void add_to_group(const std::string& name, const GmshElements& elements, Selection& group) {
    for (std::size_t e = 0; e < elements.tags.size(); ++e) {
      std::vector<int> nodes; // -1: in no hexahedron
      for (std::size_t n = e * elements.n_nodes(); n < (e + 1) * elements.n_nodes(); ++n)
        nodes.push_back(node_number_.count(elements.nodes[n]) > 0 ? node_number_[elements.nodes[n]] : -1);
      // Points and lines of the geometry may lie off the body; a group's surface must not.
      const bool is_off = std::count(nodes.begin(), nodes.end(), -1) > 0;
      if (is_off && (elements.type == point || elements.type == line)) continue;
      if (elements.type == line) {
        group.edges.push_back(sorted(std::array<int, 2>{nodes[0], nodes[1]}));
      } else if (elements.type == quadrangle) {
        const FaceNodes wanted = sorted(FaceNodes(nodes.begin(), nodes.end()));
        const auto found =
            std::lower_bound(faces_.begin(), faces_.end(), wanted,
                             [](const CellFace& face, const auto& key) { return face.vertices < key; });
        if (found == faces_.end() || found->vertices != wanted)
          refuse(fmt::format("element {} of group '{}' is no face of a hexahedron", elements.tags[e], name));
        group.faces.push_back(found->around);
        for (const auto& side : sides_of(found->around)) group.edges.push_back(sorted(side));
      } else if (elements.type == hexahedron) {
        mesh_.group_of_cell.resize(mesh_.cells.size());
        mesh_.group_of_cell[cell_number_.at(elements.tags[e])] = name;
      } else if (elements.type != point) {
        refuse(fmt::format("group '{}' has elements of type {}, which are no part of a hexahedron", name,
                           model_.type_names.at(elements.type)));
      }
      group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
    }
  }

  const GmshModel& model_;
  Mesh mesh_;
  MeshNumbers numbers_;                              ///< gmsh's tags
  std::unordered_map<std::size_t, int> node_number_; ///< by gmsh's tag; nodes of hexahedra only
  std::unordered_map<std::size_t, std::size_t> cell_number_;
  std::vector<CellFace> faces_;
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

Mesh mesh_by_gmsh(ReadGmsh& read, const MeshFile& file, bool is_geometry) {
  std::ifstream stream(file.file.path);
  if (!stream) refuse(std::string("cannot be read: ") + std::strerror(errno));
  if (!is_geometry) check_format(stream);
  const GmshModel model = read(file.file.path, is_geometry);
  Mesh mesh = Builder(model).build();
  for (Eigen::Vector3d& node : mesh.nodes.stored()) node *= file.scale;
  return mesh;
}

/// @throws std::runtime_error if an index leads out of the mesh's arrays, or a position is not finite
void check(const Mesh& mesh) {
  const auto exist = [n_nodes = mesh.nodes.size()](const auto& nodes) {
    return std::all_of(nodes.begin(), nodes.end(),
                       [&](int node) { return node >= 0 && index(node) < n_nodes; });
  };
  const auto all_exist = [&](const auto& lists) { return std::all_of(lists.begin(), lists.end(), exist); };
  const ReferenceCell& shape = reference_cell(mesh.shape);
  const auto is_cell = [&](const CellNodes& cell) { return cell.size() == shape.n_vertices; };
  const auto is_face = [&](const FaceNodes& face) { return face.size() == shape.faces[0].size(); };
  bool is_sound = !mesh.cells.empty() && all_exist(mesh.cells) &&
                  std::all_of(mesh.cells.begin(), mesh.cells.end(), is_cell) &&
                  (mesh.group_of_cell.empty() || mesh.group_of_cell.size() == mesh.cells.size()) &&
                  std::all_of(mesh.nodes.begin(), mesh.nodes.end(),
                              [](const Eigen::Vector3d& node) { return node.allFinite(); });
  for (const auto& [name, group] : mesh.groups)
    is_sound = is_sound && exist(group.nodes) && all_exist(group.edges) && all_exist(group.faces) &&
               std::all_of(group.faces.begin(), group.faces.end(), is_face);
  if (!is_sound) throw std::runtime_error("is no sound mesh");
}

} // namespace

std::string name_in_dimension(const std::string& name, int dimension) {
  constexpr std::array<const char*, 3> kinds{"point", "curve", "surface"};
  return name + " (" + kinds[index(dimension)] + ")";
}

std::string bytes_of_mesh(const Mesh& mesh) {
  return to_bytes(mesh.shape, mesh.nodes.to_vector(), mesh.cells.to_vector(), mesh.groups, mesh.group_of_cell);
}

Mesh mesh_from(const std::string& bytes) {
  Mesh mesh;
  from_bytes(bytes, mesh.shape, mesh.nodes.stored(), mesh.cells.stored(), mesh.groups, mesh.group_of_cell);
  check(mesh);
  find_grid(mesh);
  return mesh;
}

Mesh read_mesh(const MeshFile& mesh) {
  const NamedFile& file = mesh.file;
  std::error_code absent;
  if (!std::filesystem::is_regular_file(file.path, absent))
    file.refuse(absent ? absent.message() : "is no regular file");
  const bool is_geometry = std::filesystem::path(file.path).extension() == ".geo";
  if (is_geometry && std::filesystem::exists(file.path + ".opt", absent))
    file.refuse("has options for gmsh beside it, " + file.path +
                ".opt: write them into the .geo (Mesh.X = ...;)");
  try { // A .geo is a program, gmsh crashes on some broken meshes, and its answer may be anything.
    // gmsh and the ninety libraries it needs, a tenth of a second, loaded before the child is confined.
    ReadGmsh& read = **static_cast<ReadGmsh* const*>(load_shared_object("springproof_gmsh"));
    const Limits limits =
        is_geometry ? limits_to_mesh : limits_to_read(std::filesystem::file_size(file.path));
    return mesh_from(
        run_confined([&] { return bytes_of_mesh(mesh_by_gmsh(read, mesh, is_geometry)); }, limits));
  } catch (const std::exception& error) {
    file.refuse(error.what());
  }
}

} // namespace springproof::cases
