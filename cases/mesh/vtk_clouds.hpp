#pragma once

#include "cases/mesh/hex_mesh.hpp"
#include "cases/mesh/point_cloud.hpp"

/// Reading of other programs' results: see VtkFunctions.
namespace springproof::cases {

PointCloud read_points(const std::string& content);
CellCloud read_cells(const std::string& content, const HexMesh& mesh);

} // namespace springproof::cases
