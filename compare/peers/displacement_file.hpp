#pragma once

#include "cases/mesh/hex_mesh.hpp"
#include "cases/mesh/vtk_functions.hpp"

/// Displacements that another simulator computed, as they stand in a file.
namespace springproof::compare {

/// One node of the other program.
struct GivenDisplacement {
  Eigen::Vector3d position;     ///< at rest, mm
  Eigen::Vector3d displacement; ///< mm
  std::string where;            ///< for messages: "file:line", or "file: point 12"
  double rounding = 0;          ///< bound on the error of a position in single precision, mm
};

/// Comma-separated values: the header x,y,z,ux,uy,uz and a line per node, mm.
/// @param text  the file's content   @param path  its name for messages
/// @throws InputError saying where, what stands there and what is allowed
std::vector<GivenDisplacement> read_displacement_csv(const std::string& text, const std::string& path);

/// A VTK file (read_point_cloud()); among its point data an array of three components in single or double
/// precision, named msm_displacement or displacement, or the only one with three. Points with the same
/// position and displacement are one node.
/// @throws InputError, likewise
std::vector<GivenDisplacement> read_displacement_vtk(const std::string& text, const std::string& path);
/// The same of what VTK has read.
std::vector<GivenDisplacement> displacements_in(const cases::PointCloud& cloud, const std::string& path);

/// Displacements (mm) at the points of a VTK file, in its order.
/// @throws InputError, likewise
const std::vector<Eigen::Vector3d>& finite_displacements(const cases::PointCloud& cloud,
                                                         const std::string& path);

/// Distance (mm) within which a given node stands for a node of the mesh, besides the rounding of its
/// position: 1e-6 of the diagonal of the mesh's bounding box, which six digits keep near the origin.
double same_place(const cases::HexMesh& mesh);

/// Displacements in the order of the mesh's nodes, matched by position.
/// @throws InputError if a given node lies at no node of the mesh, or a node is given twice or not at all
std::vector<Eigen::Vector3d>
match_nodes(const cases::HexMesh& mesh, const std::vector<GivenDisplacement>& given, const std::string& path);

} // namespace springproof::compare
