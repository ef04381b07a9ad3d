#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

/// What gmsh reads or makes, for callers that include none of its headers. Tags are gmsh's numbers of nodes
/// and elements.
namespace springproof::cases {

using Tags = std::vector<std::size_t>;

/// gmsh's numbers of element types.
enum GmshType { line = 1, quadrangle = 3, hexahedron = 5, point = 15 };

/// Elements of one type on one entity.
struct GmshElements {
  int type;
  Tags tags, nodes;                                                  ///< nodes of one element after the other
  std::size_t n_nodes() const { return nodes.size() / tags.size(); } ///< an element
};

/// A physical group; its name is empty where it has only a number.
struct GmshGroup {
  int dimension, number;
  std::string name;
  std::vector<int> entities;
};

struct GmshModel {
  std::map<std::array<int, 2>, std::vector<GmshElements>> elements; ///< by dimension and entity
  std::map<int, std::string> type_names;
  Tags nodes;
  std::vector<double> coordinates; ///< three for each node
  std::vector<GmshGroup> groups;
};

/// Opens a file, quietly and without configuration files.
/// @param is_geometry  a .geo to be meshed, no mesh
/// @throws std::runtime_error with gmsh's message
using ReadGmsh = GmshModel(const std::string& path, bool is_geometry);

/// The function of the shared object of that name.
extern "C" ReadGmsh* const springproof_gmsh;

} // namespace springproof::cases
