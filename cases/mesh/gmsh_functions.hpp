#pragma once

#include <string>
#include <vector>

/// gmsh's functions for callers that include none of its headers. Tags are gmsh's numbers of nodes and
/// elements.
namespace springproof::cases {

using Tags = std::vector<std::size_t>;

/// gmsh's numbers of element types.
enum GmshType { line = 1, quadrangle = 3, hexahedron = 5, point = 15 };

/// Elements of one type on one entity or dimension.
struct GmshElements {
  int type;
  Tags tags;
  std::vector<Tags> nodes; ///< one list an element
};

struct GmshNodes {
  Tags tags;
  std::vector<double> coordinates; ///< three for each tag
};

/// A physical group; its name is empty where it has only a number.
struct GmshGroup {
  int dimension, number;
  std::string name;
  std::vector<int> entities;
};

/// The functions of the shared object springproof_gmsh. They are about the one model that gmsh has open, and
/// throw std::runtime_error with gmsh's message.
struct GmshFunctions {
  /// Opens a file, quietly and without configuration files.  @param is_geometry  a .geo to be meshed, no mesh
  void (*open)(const std::string& path, bool is_geometry);
  /// @param entity  one of that dimension; -1: all of them
  std::vector<GmshElements> (*elements_of)(int dimension, int entity);
  std::string (*type_name)(int type);
  GmshNodes (*nodes)();
  std::vector<GmshGroup> (*groups)();
};

/// gmsh and the ninety libraries it needs, loaded when first called: a tenth of a second.
const GmshFunctions& gmsh();

/// The symbol by which gmsh() finds them.
extern "C" const GmshFunctions springproof_gmsh;

} // namespace springproof::cases
