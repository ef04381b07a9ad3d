#pragma once

#include "cases/mesh/vtk_functions.hpp"

/// VTK's readers in a confined process: they crash on some broken files, and allocate whatever a file says
/// that it has.
namespace springproof::cases {

/// A file .stl, text or binary; coordinates are rounded to single precision.
/// @throws std::runtime_error with VTK's message; if the file has no triangles or a position that is not
/// finite
Surface read_triangles(const std::string& path);

/// @param content  of a .vtu   @throws std::runtime_error with VTK's message
PointCloud read_point_cloud(const std::string& content);

/// What the confined process answered, which may be anything; bytes_of() makes them.
/// @throws std::exception if the bytes are no such value: a field of another length than the points, no
/// triangles, a position that is not finite
Surface surface_from(const std::string& bytes);
PointCloud point_cloud_from(const std::string& bytes);
std::string bytes_of(const Surface& surface);
std::string bytes_of(const PointCloud& cloud);

} // namespace springproof::cases
