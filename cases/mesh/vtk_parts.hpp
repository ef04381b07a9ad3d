#pragma once

#include "cases/mesh/vtk_functions.hpp"

class vtkAlgorithm;

/// What the sources of the shared object springproof_vtk have for each other; VtkFunctions says what they do.
namespace springproof::cases {

/// Runs a reader or writer of VTK's, which prints nothing.
/// @throws std::runtime_error with its first error, without the place in VTK's source
void run(vtkAlgorithm& algorithm);

/// The same for a reader that reads no more than what its file says about its content.
void run_information(vtkAlgorithm& algorithm);

PointCloud read_points(const std::string& content);
CellCloud read_cells(const std::string& content, const HexMesh& mesh);

Surface read_polygons(const std::string& content);
Surface contour_of(const Picture& picture, const ContourSettings& settings);
Surface decimated_surface(const TriangleMesh& surface, std::size_t n_triangles);
std::vector<PlaceInCell> nearest_in_cells(const HexMesh& mesh, const std::vector<Eigen::Vector3d>& positions);

/// Reads a file .nii or .nii.gz by VTK, or .inv3.
/// @param bytes  bytes_of_volume(); compressed ones are inflated twice, to check them first
/// @throws std::runtime_error with VTK's message, or the reason
Volume read_volume(const std::string& path, const VolumeBytes& bytes);

/// Reads a project of InVesalius: a gzipped tar whose main.plist names the file of the voxels, int16, least
/// byte first, its shape (z, y, x) and the spacing (x, y, z).
/// @throws std::runtime_error if it is none
Volume read_inv3(const std::string& path, const VolumeBytes& bytes);

} // namespace springproof::cases
