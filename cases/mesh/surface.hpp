#pragma once

#include "cases/case/error.hpp"

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace springproof::cases {

/// A surface of triangles, seen from outside anticlockwise, mm.
using Surface = std::vector<std::array<Eigen::Vector3d, 3>>;

/// Reads a surface in STL, text or binary; coordinates are rounded to single precision.
/// @param where  the place in a case file that names it, for messages
/// @throws InputError if it cannot be read, ends within a triangle, has none or a position that is not finite
Surface read_stl(const std::string& path, const Where& where);

/// Whether every edge of a triangle is met by another triangle's that runs the other way: then the surface
/// has an inside. Vertices are the same when their coordinates are. (VTK's boundary edges have no direction:
/// they miss a triangle that is turned over, and report an edge that two closed parts share.)
/// @return how many edges have no such partner; 0: closed
std::size_t n_open_edges(const Surface& surface);

} // namespace springproof::cases
