#pragma once

#include "cases/case/body.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <fmt/format.h>

namespace springproof::cases {

/// Reads the triangles of a surface in STL, OBJ, PLY (rounded to single precision) or VTP.
/// @throws InputError if it cannot be read, ends within a triangle, has none or a position that is not finite
/// @param remarks  as in read_triangles()
Surface read_body_surface(const NamedFile& file, std::vector<std::string>* remarks = nullptr);

/// Whether every edge of a triangle is met by another triangle's that runs the other way: then the surface
/// has an inside. (VTK's boundary edges have no direction: they miss a triangle that is turned over, and
/// report an edge that two closed parts share.)
/// @param surface  joined()
/// @return how many edges have no such partner; 0: closed
std::size_t n_open_edges(const TriangleMesh& surface);

/// Approximate number of cubes that make_voxel_mesh() makes, from the volume within the surface, and its
/// grid's numbers of cubes along the axes (a million where there are more).
/// @throws InputError if the surface cannot be read
struct VoxelCounts {
  double in_body;
  std::array<int, 3> of_grid;
};
VoxelCounts count_voxels(const Voxels& voxels);

/// The grid of cubes of a voxel body: a cube belongs to it when its centre is inside the surface (winding
/// number other than 0, by a ray along z through the centre). All cubes hang together by faces.
/// @throws InputError, at the place of the surface in the case file, if the surface cannot be read or is not
/// closed, if no centre is inside, if the cubes fall into pieces, or if the grid would have over 50 million
/// cubes
/// @param remarks  as in read_triangles()
Mesh make_voxel_mesh(const Voxels& voxels, std::vector<std::string>* remarks = nullptr);
/// The same for a surface that has been read and scaled.
Mesh make_voxel_mesh(const Surface& surface, const Voxels& voxels);

/// Says that a body falls into pieces.
/// @param sizes  numbers of their cells, two or more   @param edge  of a cell, mm
std::string several_pieces(std::vector<std::size_t> sizes, double edge);

/// Hint in messages about a body that is too small or too large for its cells.
/// @param size  along the axes, mm
inline std::string scale_hint(const Eigen::Vector3d& size) {
  return fmt::format("the file's body is {:.4g} x {:.4g} x {:.4g} mm; where its unit is another, body.scale "
                     "says how many mm that is (1000 for metres)",
                     size.x(), size.y(), size.z());
}

} // namespace springproof::cases
