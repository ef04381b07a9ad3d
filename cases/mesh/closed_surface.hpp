#pragma once

#include "cases/case/error.hpp"
#include "cases/mesh/triangle_mesh.hpp"

/// Surfaces of files that have to bound something.
namespace springproof::cases {

/// @param or_else  another way out where edges have more than two triangles, after a comma; empty: none
/// @throws InputError, at the file's name, unless every edge has two triangles that run along it in opposite
/// directions
void check_is_closed(const TriangleMesh& surface, const NamedFile& file, const std::string& or_else = "");

/// Volumes of the parts that share no vertex: bodies, bodies that overlap, or cavities.
/// @return mm³; < 0: the part's triangles are seen from outside clockwise
std::vector<double> volumes_of_parts(const TriangleMesh& surface);

double area_of(const TriangleMesh& surface); ///< mm²
/// Whether a closed surface bounds more than its triangles' rounding, as one that lies in a plane does not.
bool has_volume(const TriangleMesh& surface);

/// The surface of a rigid body, for distances: triangles that are all turned inwards are turned outwards.
/// @param scale    mm of a unit of the surface    @param remarks  says that they were turned
/// @throws InputError, at the file's name, if it is not closed, has a triangle without an area, more
/// triangles than distances are found from in good time, no volume, or parts that are turned inwards
TriangleMesh rigid_surface(const Surface& triangles, double scale, const NamedFile& file,
                           std::vector<std::string>& remarks);

} // namespace springproof::cases
