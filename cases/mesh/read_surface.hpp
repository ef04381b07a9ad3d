#pragma once

#include "cases/mesh/vtk_functions.hpp"

/// Surfaces by VTK, in a confined process.
namespace springproof::cases {

/// The triangles of a file .stl (text or binary, single precision) or .vtp (polygons are divided). It need
/// not be closed.
/// @param remarks  as of read_triangles()
/// @throws std::runtime_error with VTK's message; if it has no triangles or a position that is not finite
TriangleMesh read_surface(const std::string& path, std::vector<std::string>* remarks = nullptr);

/// The surface that divides a picture's points of a value above the level from the others: closed, because
/// beyond its borders a picture is below the level; seen from outside anticlockwise, outside being below.
/// @throws std::runtime_error if there is none; if the sizes of the picture are not as many as its values
TriangleMesh contour(const Picture& picture, const ContourSettings& settings);

/// A surface in about so many triangles, where it has more, by quadric decimation, in 20 s or not at all.
/// @throws std::runtime_error with VTK's message; if it takes longer, or no triangle is left
TriangleMesh decimated(const TriangleMesh& surface, std::size_t n_triangles);

} // namespace springproof::cases
