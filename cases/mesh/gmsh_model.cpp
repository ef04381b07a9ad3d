#include "cases/mesh/mesh_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <gmsh.h>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <unordered_map>

namespace springproof::cases {

namespace {

/// gmsh would run a script NAME.msh.opt beside a mesh; a mesh is therefore opened by its descriptor, beside
/// which there is none.
void open_file(const std::string& path, bool is_geometry) {
  gmsh::open(is_geometry ? path : "/proc/self/fd/" + std::to_string(::open(path.c_str(), O_RDONLY)));
  if (is_geometry) gmsh::model::mesh::generate(3);
}

/// What gmsh says of a type of elements.
struct GmshType {
  ElementKind kind;
  std::size_t n_corners, n_nodes;
};

GmshType type_of(int number) {
  std::string name;
  int dimension, order, n_nodes, n_corners;
  std::vector<double> local;
  gmsh::model::mesh::getElementProperties(number, name, dimension, order, n_nodes, local, n_corners);
  const auto found = std::find_if(element_kinds.begin(), element_kinds.end(), [&](const auto& kind) {
    return kind.dimension == dimension && kind.n_corners == n_corners;
  });
  return {found == element_kinds.end() ? ElementKind::other : found->kind,
          static_cast<std::size_t>(n_corners), static_cast<std::size_t>(n_nodes)};
}

void add_elements(int dimension, int entity, MeshFileContent& content) {
  std::vector<int> types;
  std::vector<Tags> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
  std::vector<FileElements>& all = content.elements[{dimension, entity}];
  for (std::size_t t = 0; t < types.size(); ++t) {
    if (tags[t].empty()) continue;
    const GmshType type = type_of(types[t]);
    FileElements& elements = all.emplace_back();
    elements.kind = type.kind;
    elements.is_linear = type.n_nodes == type.n_corners;
    for (std::size_t e = 0; e < tags[t].size() && type.kind != ElementKind::other; ++e) // corners come first
      for (std::size_t v = 0; v < type.n_corners; ++v)
        elements.nodes.push_back(nodes[t].at(e * type.n_nodes + v));
    elements.tags = std::move(tags[t]);
  }
}

/// Reads what a file of format 2 says of its elements: the group of each, by its number; 0 is none.
class GroupsOfElements {
 public:
  explicit GroupsOfElements(const std::string& path) : file_(path, std::ios::binary) {}

  std::unordered_map<std::size_t, int> read() {
    seek("$MeshFormat");
    double version;
    int is_binary;
    file_ >> version >> is_binary;
    if (is_binary != 0) {
      std::string rest;
      std::getline(file_, rest);
      is_swapped_ = number() != 1;
    }
    seek("$Elements");
    std::size_t n = 0;
    std::string rest;
    file_ >> n;
    std::getline(file_, rest);
    for (std::size_t n_read = 0; n_read < n && file_;) n_read += is_binary != 0 ? read_block() : read_line();
    if (!file_) throw std::runtime_error("ends within its elements");
    return std::move(group_of_);
  }

 private:
  void seek(const std::string& heading) {
    for (std::string line; std::getline(file_, line);)
      if (line.compare(0, heading.size(), heading) == 0) return;
    throw std::runtime_error("has no " + heading);
  }

  /// Reads a line "number type n_tags group entity ... nodes".  @return 1
  std::size_t read_line() {
    std::size_t tag = 0;
    int type = 0, n_tags = 0, group = 0;
    file_ >> tag >> type >> n_tags;
    if (n_tags > 0) file_ >> group;
    group_of_[tag] = group;
    file_.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    return 1;
  }

  /// Reads elements of one type: the type, their number, that of their tags; then each with its number.
  /// @return how many
  std::size_t read_block() {
    const int type = number(), n = number(), n_tags = number();
    if (n < 1) throw std::runtime_error("has a block of no elements");
    const std::size_t n_nodes = type_of(type).n_nodes;
    for (int e = 0; e < n && file_; ++e) {
      int& group = group_of_[static_cast<std::size_t>(number())];
      for (int t = 0; t < n_tags && file_; ++t) {
        const int tag = number();
        if (t == 0) group = tag;
      }
      file_.ignore(static_cast<std::streamsize>(n_nodes * sizeof(std::int32_t)));
    }
    return static_cast<std::size_t>(n);
  }

  std::int32_t number() {
    std::uint32_t bits = 0;
    file_.read(reinterpret_cast<char*>(&bits), sizeof bits);
    if (is_swapped_) bits = __builtin_bswap32(bits);
    std::int32_t value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

  std::ifstream file_;
  bool is_swapped_ = false;
  std::unordered_map<std::size_t, int> group_of_;
};

/// Puts elements into one entity for each of their groups.
void divide_by_groups(const std::unordered_map<std::size_t, int>& group_of, MeshFileContent& content) {
  decltype(content.elements) divided;
  for (const auto& [place, of_entity] : content.elements)
    for (const FileElements& elements : of_entity) {
      std::map<int, FileElements> by_group;
      const std::size_t n_nodes = elements.nodes.size() / elements.tags.size();
      for (std::size_t e = 0; e < elements.tags.size(); ++e) {
        const auto found = group_of.find(elements.tags[e]);
        FileElements& part = by_group[found == group_of.end() ? 0 : found->second];
        part.kind = elements.kind;
        part.is_linear = elements.is_linear;
        part.tags.push_back(elements.tags[e]);
        const auto first = elements.nodes.begin() + static_cast<std::ptrdiff_t>(e * n_nodes);
        part.nodes.insert(part.nodes.end(), first, first + static_cast<std::ptrdiff_t>(n_nodes));
      }
      for (auto& [group, part] : by_group) divided[{place[0], group}].push_back(std::move(part));
    }
  content.elements = std::move(divided);
  content.has_elements_by_group = true;
  for (FileGroup& group : content.groups) {
    content.elements[{group.dimension, group.number}]; // named in the file, without elements
    group.entities = {group.number};
  }
}

MeshFileContent content_of_model() {
  MeshFileContent content;
  gmsh::vectorpair found;
  gmsh::model::getEntities(found);
  for (const auto& [dimension, entity] : found) add_elements(dimension, entity, content);
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(content.nodes, content.coordinates, parametric, -1, -1, false, false);
  gmsh::model::getPhysicalGroups(found);
  for (const auto& [dimension, number] : found) {
    FileGroup& group = content.groups.emplace_back(FileGroup{dimension, number, {}, {}});
    gmsh::model::getPhysicalName(dimension, number, group.name);
    gmsh::model::getEntitiesForPhysicalGroup(dimension, number, group.entities);
  }
  return content;
}

void start() {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
}

MeshFileContent read(const std::string& path, GmshFile kind) try {
  start();
  open_file(path, kind == GmshFile::geometry);
  MeshFileContent content = content_of_model();
  if (kind == GmshFile::format_2) divide_by_groups(GroupsOfElements(path).read(), content);
  return content;
} catch (const std::string& reason) { // gmsh throws its messages
  throw std::runtime_error("gmsh: " + reason);
}

/// A surface of triangles, and the volume in it.
void add_surface(const std::vector<std::array<double, 3>>& vertices,
                 const std::vector<std::array<int, 3>>& triangles) {
  const int surface = gmsh::model::addDiscreteEntity(2);
  Tags tags, nodes;
  std::vector<double> coordinates;
  for (const auto& vertex : vertices) {
    tags.push_back(tags.size() + 1);
    coordinates.insert(coordinates.end(), vertex.begin(), vertex.end());
  }
  gmsh::model::mesh::addNodes(2, surface, tags, coordinates);
  for (const auto& triangle : triangles)
    for (const int vertex : triangle) nodes.push_back(static_cast<std::size_t>(vertex) + 1);
  constexpr int triangle_type = 2;
  gmsh::model::mesh::addElementsByType(surface, triangle_type, {}, nodes);
}

/// Meshes the volume inside of all surfaces of the model.
void mesh_inside(double size) {
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(surfaces, 2);
  std::vector<int> loop;
  for (const auto& entity : surfaces) loop.push_back(entity.second);
  gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop(loop)});
  gmsh::model::geo::synchronize();
  gmsh::option::setNumber("Mesh.MeshSizeMin", size);
  gmsh::option::setNumber("Mesh.MeshSizeMax", size);
  gmsh::model::mesh::generate(3);
}

MeshFileContent fill(const std::vector<std::array<double, 3>>& vertices,
                     const std::vector<std::array<int, 3>>& triangles, double size) try {
  start();
  std::string reason;
  try { // edges sharper than 40 degrees stay; each piece between them is meshed anew
    constexpr double sharp = 40 * 3.14159265358979323846 / 180;
    add_surface(vertices, triangles);
    gmsh::model::mesh::classifySurfaces(sharp, true, true);
    gmsh::model::mesh::createGeometry();
    mesh_inside(size);
    return content_of_model();
  } catch (const std::string& message) {
    reason = message;
  }
  gmsh::clear();
  add_surface(vertices, triangles);
  mesh_inside(size);
  MeshFileContent content = content_of_model();
  content.remarks.push_back(
      "its triangles stay as they are, so size is that of inner edges alone (gmsh: " + reason + ")");
  return content;
} catch (const std::string& reason) {
  throw std::runtime_error("gmsh: " + reason);
}

} // namespace

extern "C" const GmshFunctions springproof_gmsh{read, fill};

} // namespace springproof::cases
