#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

/// What a mesh file holds, for callers that include no header of gmsh's or VTK's.
namespace springproof::cases {

/// Numbers of nodes and elements in a file.
using Tags = std::vector<std::size_t>;

enum class ElementKind { point, line, triangle, quadrangle, tetrahedron, hexahedron, wedge, pyramid, other };

struct ElementKindTraits {
  ElementKind kind;
  int dimension, n_corners;
  const char *name, *names; ///< singular and plural, for messages
};
inline constexpr std::array<ElementKindTraits, 9> element_kinds{
    {{ElementKind::point, 0, 1, "point", "points"},
     {ElementKind::line, 1, 2, "line", "lines"},
     {ElementKind::triangle, 2, 3, "triangle", "triangles"},
     {ElementKind::quadrangle, 2, 4, "quadrangle", "quadrangles"},
     {ElementKind::tetrahedron, 3, 4, "tetrahedron", "tetrahedra"},
     {ElementKind::hexahedron, 3, 8, "hexahedron", "hexahedra"},
     {ElementKind::wedge, 3, 6, "wedge", "wedges"},
     {ElementKind::pyramid, 3, 5, "pyramid", "pyramids"},
     {ElementKind::other, -1, 0, "other element", "other elements"}}};
inline const ElementKindTraits& traits_of(ElementKind kind) {
  return element_kinds[static_cast<std::size_t>(kind)];
}

/// Elements of one kind on one entity.
struct FileElements {
  ElementKind kind;
  bool is_linear; ///< has no nodes but its corners
  Tags tags;
  Tags nodes; ///< the corners of one element after the other, in the order of gmsh and VTK
};

/// A physical group; its name is empty where it has only a number.
struct FileGroup {
  int dimension, number;
  std::string name;
  std::vector<int> entities;
};

struct MeshFileContent {
  std::map<std::array<int, 2>, std::vector<FileElements>> elements; ///< by dimension and entity
  Tags nodes;
  std::vector<double> coordinates; ///< three for each node
  std::vector<FileGroup> groups;
  std::vector<std::string> remarks;   ///< how the groups were found
  bool has_elements_by_group = false; ///< an element of several groups is listed in each
};

/// What gmsh is given. Format 2 has the groups of single elements, of which gmsh makes groups of entities.
enum class GmshFile { geometry, format_2, format_4 };

/// The functions of the shared object springproof_gmsh, which open files quietly and without configuration
/// files. They throw std::runtime_error with gmsh's message.
struct GmshFunctions {
  MeshFileContent (*read)(const std::string& path, GmshFile kind);
  /// Tetrahedra inside a closed surface, whose triangles are made anew in about their size where gmsh can.
  /// @param triangles  by their vertices' places in the list   @param size  of edges
  MeshFileContent (*fill)(const std::vector<std::array<double, 3>>& vertices,
                          const std::vector<std::array<int, 3>>& triangles, double size);
};

/// The symbol by which they are found.
extern "C" const GmshFunctions springproof_gmsh;

} // namespace springproof::cases
