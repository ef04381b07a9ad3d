#pragma once

#include "cases/mesh/vtk_functions.hpp"

/// Surfaces of triangles: see VtkFunctions.
namespace springproof::cases {

Surface read_polygons(const std::string& content);
Surface contour_of(const Picture& picture, const ContourSettings& settings);
Surface decimated_surface(const TriangleMesh& surface, std::size_t n_triangles);
std::vector<PlaceInCell> nearest_in_cells(const HexMesh& mesh, const std::vector<Eigen::Vector3d>& positions);

} // namespace springproof::cases
