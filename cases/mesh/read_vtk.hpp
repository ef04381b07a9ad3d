#pragma once

#include "cases/mesh/vtk_functions.hpp"

/// VTK's readers in a confined process: they crash on some broken files, and allocate whatever a file says
/// that it has.
namespace springproof::cases {

/// A file .stl, text or binary; coordinates are rounded to single precision. What follows the last triangle
/// of a binary file and a triangle that is there twice are left out.
/// @param remarks  receives what was left out, and how many triangles have no area
/// @throws std::runtime_error with VTK's message; if the file has no triangles or a position that is not
/// finite
Surface read_triangles(const std::string& path, std::vector<std::string>* remarks = nullptr);

/// @param content  of a file .vtu, .vtp, .vts, .vtr, .vti or .vtk
/// @throws std::runtime_error with VTK's message; if it has no points
PointCloud read_point_cloud(const std::string& content);

/// The same with interpolation between its points and the nodes of a mesh.
/// @throws std::runtime_error likewise; if it has no cells of a volume, or none near a node of the mesh
CellCloud read_cell_cloud(const std::string& content, const HexMesh& mesh);

/// What the confined process answered, which may be anything; bytes_of() makes them.
/// @throws std::exception if the bytes are no such value: a field of another length than the points, no
/// triangles, a position that is not finite, a weight of a point that does not exist
Surface surface_from(const std::string& bytes);
PointCloud point_cloud_from(const std::string& bytes);
CellCloud cell_cloud_from(const std::string& bytes, std::size_t n_nodes);
std::string bytes_of(const Surface& surface);
std::string bytes_of(const PointCloud& cloud);
std::string bytes_of(const CellCloud& cloud);

} // namespace springproof::cases
