#pragma once

#include "cases/mesh/hex_mesh.hpp"

namespace springproof::cases {

/// A face of a cell.
struct CellFace {
  std::array<int, 4> vertices; ///< ascending
  std::size_t cell;
  std::array<int, 4> around; ///< the same vertices, seen from outside of the cell anticlockwise
};

/// The six faces of every cell, so that those of the same vertices follow each other, the lowest cell first.
std::vector<CellFace> faces_of_cells(const HexMesh& mesh);

/// Numbers of a mesh's nodes and cells in the file that it was made from, for messages.
struct MeshNumbers {
  std::vector<std::size_t> of_nodes, of_cells;
};

/// Checks that a mesh is sound, whatever it was made from; a grid of cells is so by construction. The models
/// would take a mistake for a crack, or for more material than there is.
/// @param faces  faces_of_cells() of the mesh
/// @throws std::runtime_error with the first of these, by the file's numbers: cells that are inverted or
/// degenerate, listed twice, on one side of the face between them, or three at a face; pieces that share no
/// node; nodes at the surface that lie on a cell (to 1 % of the shortest edge there) of which they are no
/// vertices: in the place of one, on a face (hanging), or inside
void check_mesh(const HexMesh& mesh, const std::vector<CellFace>& faces, const MeshNumbers& numbers);

} // namespace springproof::cases
