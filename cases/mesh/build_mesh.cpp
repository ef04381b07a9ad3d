#include "cases/mesh/mesh_file.hpp"
#include "cases/mesh/read_mesh.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <unordered_map>

namespace springproof::cases {

namespace {

[[noreturn]] void refuse_mesh_file(const std::string& reason) {
  throw std::runtime_error(reason);
}

std::string count_of(std::size_t n, ElementKind kind) {
  return fmt::format("{} {}", n, n == 1 ? traits_of(kind).name : traits_of(kind).names);
}

/// "2 wedges, 3 pyramids and 4 tetrahedra"
std::string list_of(const std::map<ElementKind, std::size_t>& counts) {
  std::string text;
  std::size_t n_left = counts.size();
  for (const auto& [kind, n] : counts) {
    if (!text.empty()) text += n_left == 1 ? " and " : ", ";
    text += count_of(n, kind);
    --n_left;
  }
  return text;
}

/// Makes the mesh of a file's content, and remembers which node and cell is which of the file's.
class Builder {
 public:
  explicit Builder(MeshFileContent content) : content_(std::move(content)) {}

  MeshWithRemarks build() {
    find_shape();
    read_cells();
    read_nodes();
    turn_if_inside_out();
    faces_ = faces_of_cells(mesh_);
    check_mesh(mesh_, faces_, numbers_);
    read_groups();
    return {std::move(mesh_), std::move(content_.remarks)};
  }

 private:
  template<class Action>
  void for_each_solid(const Action& action) const {
    for (const auto& [place, of_entity] : content_.elements)
      for (const FileElements& elements : of_entity)
        if (place[0] == 3) action(elements);
  }

  void find_shape() {
    std::map<ElementKind, std::size_t> counts;
    std::size_t n_curved = 0;
    for_each_solid([&](const FileElements& elements) {
      counts[elements.kind] += elements.tags.size();
      n_curved += elements.is_linear ? 0 : elements.tags.size();
    });
    if (counts.empty()) refuse_without_cells();
    const ElementKind kind = counts.begin()->first;
    if (counts.size() > 1 || (kind != ElementKind::hexahedron && kind != ElementKind::tetrahedron))
      refuse_mesh_file(fmt::format(
          "has {}, must have hexahedra alone or tetrahedra alone: mesh the body by one of them (gmsh makes "
          "tetrahedra where nothing is recombined and extruded by Layers); or write its closed surface as "
          "STL, which shape = \"surface\" fills",
          list_of(counts)));
    kind_ = kind;
    mesh_.shape = kind == ElementKind::hexahedron ? CellShape::hexahedron : CellShape::tetrahedron;
    if (n_curved > 0)
      content_.remarks.push_back(fmt::format(
          "{} of its {} have nodes between their corners, which are left out: edges become straight",
          n_curved, count_of(counts[kind], kind)));
  }

  [[noreturn]] void refuse_without_cells() const {
    bool has_surface = false;
    for (const auto& [place, of_entity] : content_.elements)
      has_surface = has_surface || (place[0] == 2 && !of_entity.empty());
    refuse_mesh_file(fmt::format(
        "has no hexahedra or tetrahedra{}. A file that gmsh has saved has its physical groups alone, where "
        "there are any: one of them must be the body, Physical Volume(\"body\") = {{...}};, or Mesh.SaveAll "
        "must be 1",
        has_surface
            ? ", but elements of a surface: a closed surface in STL, OBJ, PLY or VTP is a body of shape = "
              "\"surface\""
            : ""));
  }

  /// All three-dimensional elements, their nodes by the file's tags for the moment.
  void read_cells() {
    const std::size_t n_vertices = reference().n_vertices;
    std::map<std::vector<std::size_t>, std::size_t>
        before; // cells of the groups before, by their sorted nodes
    for_each_solid([&](const FileElements& elements) {
      const std::size_t n_before = mesh_.cells.size();
      for (std::size_t e = 0; e < elements.tags.size(); ++e) {
        if (content_.has_elements_by_group) {
          const auto first = elements.nodes.begin() + static_cast<std::ptrdiff_t>(n_vertices * e);
          const auto [known, is_new] = before.try_emplace(
              sorted(Tags(first, first + static_cast<std::ptrdiff_t>(n_vertices))), mesh_.cells.size());
          if (!is_new && known->second < n_before) {
            cell_number_[elements.tags[e]] = known->second;
            continue;
          }
        }
        cell_number_[elements.tags[e]] = mesh_.cells.size();
        numbers_.of_cells.push_back(elements.tags[e]);
        CellNodes& cell = mesh_.cells.stored().emplace_back();
        for (std::size_t v = 0; v < n_vertices; ++v) {
          const std::size_t around = mesh_.shape == CellShape::hexahedron ? around_cell[v] : v,
                            tag = elements.nodes.at(n_vertices * e + around);
          if (tag > 2147483647)
            refuse_mesh_file(fmt::format("has a node of number {}, must be below 2^31", tag));
          cell.push_back(static_cast<int>(tag));
        }
      }
    });
  }

  /// The nodes that cells have, in the order of their tags.
  void read_nodes() {
    std::unordered_map<std::size_t, std::size_t> place;
    for (std::size_t n = 0; n < content_.nodes.size(); ++n) place[content_.nodes[n]] = n;
    std::vector<int> used;
    for (const auto& cell : mesh_.cells) used.insert(used.end(), cell.begin(), cell.end());
    make_set(used);
    for (const int tag : used) {
      const auto found = place.find(index(tag));
      if (found == place.end())
        refuse_mesh_file(fmt::format("has a {} with node {}, which does not exist", reference().name, tag));
      node_number_[index(tag)] = static_cast<int>(mesh_.nodes.size());
      numbers_.of_nodes.push_back(index(tag));
      mesh_.nodes.stored().emplace_back(&content_.coordinates.at(3 * found->second));
      if (!mesh_.nodes.values.back().allFinite())
        refuse_mesh_file(fmt::format("has node {} at a position that is not finite", tag));
    }
    for (auto& cell : mesh_.cells.stored())
      for (int& node : cell) node = node_number_[index(node)];
  }

  /// Some programs number all tetrahedra the other way round. Where only some are like that, the mesh is
  /// wrong.
  void turn_if_inside_out() {
    if (mesh_.shape != CellShape::tetrahedron) return;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      if (!(cell_volume(cell_corners(mesh_, c)) < 0)) return;
    for (CellNodes& cell : mesh_.cells.stored()) std::swap(cell[0], cell[1]);
    content_.remarks.push_back(
        fmt::format("all of its {} are inside out, and are turned", count_of(mesh_.cells.size(), kind_)));
  }

  void read_groups() {
    std::map<std::string, std::map<int, Selection>> by_name; // and dimension
    std::stable_sort(content_.groups.begin(), content_.groups.end(), [this](const auto& a, const auto& b) {
      return n_elements(a) > n_elements(b); // a cell gets the name of the smallest group that has it
    });
    for (const FileGroup& group : content_.groups) {
      const std::string name = group.name.empty() ? std::to_string(group.number) : group.name;
      for (const int entity : group.entities)
        for (const FileElements& elements : content_.elements.at({group.dimension, entity}))
          add_to_group(name, elements, by_name[name][group.dimension]);
    }
    if (n_renamed_ > 0)
      content_.remarks.push_back(fmt::format(
          "{} are in several groups of cells, of which the smallest has them as its class and material",
          count_of(n_renamed_, kind_)));
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

  std::size_t n_elements(const FileGroup& group) const {
    std::size_t n = 0;
    for (const int entity : group.entities)
      for (const FileElements& elements : content_.elements.at({group.dimension, entity}))
        n += elements.tags.size();
    return n;
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

  void add_to_group(const std::string& name, const FileElements& elements, Selection& group) {
    const auto n_nodes = static_cast<std::size_t>(traits_of(elements.kind).n_corners);
    const auto dimension = traits_of(elements.kind).dimension;
    for (std::size_t e = 0; e < elements.tags.size(); ++e) {
      std::vector<int> nodes; // -1: in no cell
      for (std::size_t n = e * n_nodes; n < (e + 1) * n_nodes; ++n) {
        const auto found = node_number_.find(elements.nodes.at(n));
        nodes.push_back(found == node_number_.end() ? -1 : found->second);
      }
      // Points and lines of the geometry may lie off the body; a group's surface must not.
      const bool is_off = std::count(nodes.begin(), nodes.end(), -1) > 0;
      if (is_off && dimension < 2) continue;
      if (elements.kind == ElementKind::line) {
        group.edges.push_back(sorted(std::array<int, 2>{nodes[0], nodes[1]}));
      } else if (dimension == 2 && nodes.size() == reference().faces[0].size()) {
        add_face(name, elements.tags[e], FaceNodes(nodes.begin(), nodes.end()), group);
      } else if (elements.kind == kind_) {
        mesh_.group_of_cell.resize(mesh_.cells.size());
        std::string& of_cell = mesh_.group_of_cell[cell_number_.at(elements.tags[e])];
        n_renamed_ += !of_cell.empty() && of_cell != name ? 1 : 0;
        of_cell = name;
      } else if (elements.kind != ElementKind::point) {
        refuse_mesh_file(fmt::format("group '{}' has {}, which are no part of a {}", name,
                                     count_of(elements.tags.size(), elements.kind), reference().name));
      }
      group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
    }
  }

  void add_face(const std::string& name, std::size_t tag, const FaceNodes& nodes, Selection& group) const {
    const FaceNodes wanted = sorted(nodes);
    const auto found =
        std::lower_bound(faces_.begin(), faces_.end(), wanted,
                         [](const CellFace& face, const auto& key) { return face.vertices < key; });
    if (found == faces_.end() || found->vertices != wanted)
      refuse_mesh_file(
          fmt::format("element {} of group '{}' is no face of a {}", tag, name, reference().name));
    group.faces.push_back(found->around);
    for (const auto& side : sides_of(found->around)) group.edges.push_back(sorted(side));
  }

  const ReferenceCell& reference() const { return reference_cell(mesh_.shape); }

  MeshFileContent content_;
  ElementKind kind_ = ElementKind::hexahedron; ///< the cells'
  Mesh mesh_;
  std::size_t n_renamed_ = 0;                        ///< cells of several groups
  MeshNumbers numbers_;                              ///< the file's tags
  std::unordered_map<std::size_t, int> node_number_; ///< by the file's tag; nodes of cells only
  std::unordered_map<std::size_t, std::size_t> cell_number_;
  std::vector<CellFace> faces_;
};

} // namespace

MeshWithRemarks mesh_of(MeshFileContent content) {
  return Builder(std::move(content)).build();
}

std::string name_in_dimension(const std::string& name, int dimension) {
  constexpr std::array<const char*, 3> kinds{"point", "curve", "surface"};
  return name + " (" + kinds[index(dimension)] + ")";
}

} // namespace springproof::cases
