#pragma once

#include "cases/scene/scene.hpp"

#include <Eigen/Geometry>
#include <array>
#include <vector>

/// Rigid tools in CalculiX's input: a layer of hexahedra under a tool's surface, all of whose nodes are held.
namespace springproof::compare {

/// A tool's surface in quadrilaterals whose vertices lie on it, each the first face of a hexahedron.
struct ToolMesh {
  std::vector<Eigen::Vector3d> nodes;    ///< mm, at load factor 0
  std::vector<std::array<int, 8>> cells; ///< in CalculiX's order: the surface's vertices are the first four
};

/// Meshes the part of a tool that can touch the body at full load: all facets in the box of the body at rest,
/// grown by the tool's way and the indentation; by the body's own size, if loads may bring it to the tool. A
/// facet of a curved surface is nowhere further below it than an
/// equilibrium's surface may be from the tool, a thousandth of the indentation. A punch has its flat end
/// alone.
/// @param scene  as its finite elements have it: already refined
/// @return no cells, if no facet can    @throws SolveError where the indentation is so small that there would
/// be too many
ToolMesh mesh_of_tool(const cases::Scene& scene, const cases::Tool& tool);

} // namespace springproof::compare
