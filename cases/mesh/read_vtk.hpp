#pragma once

#include "cases/mesh/vtk_functions.hpp"

/// VTK's readers and filters in a confined process: they crash on some broken files, and allocate whatever a
/// file says that it has.
namespace springproof::cases {

/// Reads a file .stl, text or binary; coordinates are rounded to single precision. Anything after a binary
/// file's last triangle, and a triangle that is there twice, are left out.
/// @param remarks  receives what was left out, and how many triangles have no area
/// @throws std::runtime_error with VTK's message; if the file has no triangles or a position that is not
/// finite
Surface read_triangles(const std::string& path, std::vector<std::string>* remarks = nullptr);

/// @param content  the content of a file .vtu, .vtp, .vts, .vtr, .vti or .vtk
/// @throws std::runtime_error with VTK's message; if it has no points
PointCloud read_point_cloud(const std::string& content);

/// The same with interpolation between its points and the nodes of a mesh.
/// @throws std::runtime_error likewise; if it has no cells of a volume, or none near a node of the mesh
CellCloud read_cell_cloud(const std::string& content, const HexMesh& mesh);

/// The triangles of a file .stl (text or binary, single precision) or .vtp (polygons are divided). It need
/// not be closed.
/// @param remarks  as in read_triangles()
/// @throws std::runtime_error with VTK's message; if it has no triangles or a position that is not finite
TriangleMesh read_surface(const std::string& path, std::vector<std::string>* remarks = nullptr);

/// The surface that divides a picture's points with a value above the level from the others: closed, because
/// beyond its borders a picture is below the level; seen from outside anticlockwise, outside being below.
/// @throws std::runtime_error if there is none; if the sizes of the picture are not as many as its values
TriangleMesh contour(const Picture& picture, const ContourSettings& settings);

/// Reduces a surface with more triangles to about so many, by quadric decimation, in 20 s or not at all.
/// @throws std::runtime_error with VTK's message; if it takes longer, or no triangle is left
TriangleMesh decimated(const TriangleMesh& surface, std::size_t n_triangles);

/// Values in the bytes that a confined process answered, which may be anything; bytes_of() makes them.
/// @throws std::exception if the bytes are no such value: a field of another length than the points, no
/// triangles, a position that is not finite, a weight of a point that does not exist
Surface surface_from(const std::string& bytes);
PointCloud point_cloud_from(const std::string& bytes);
CellCloud cell_cloud_from(const std::string& bytes, std::size_t n_nodes);
std::string bytes_of(const Surface& surface);
std::string bytes_of(const PointCloud& cloud);
std::string bytes_of(const CellCloud& cloud);

} // namespace springproof::cases
