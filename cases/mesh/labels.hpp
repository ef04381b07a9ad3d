#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/mesh.hpp"
#include "cases/mesh/vtk_functions.hpp"

namespace springproof::cases {

/// A grid of cubes, each with its class.
struct LabelGrid {
  std::array<int, 3> cells{};
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(); ///< mm
  std::vector<std::uint8_t>
      class_of_cell;             ///< x fastest; 0: none, else one more than a place in Labels::classes
  float lowest = 0, highest = 0; ///< the whole picture's intensities; those that are no numbers are left out
  Eigen::Vector3d size = Eigen::Vector3d::Zero(); ///< mm, the whole picture
};

/// The classes of the cells that cover a volume, or its crop: each cell takes the class that fills most of
/// it. A voxel has the first class whose interval has its intensity; what lies outside of the volume or in
/// no class is empty. Where two fill as much, a class wins over none, and the first one over the others.
/// @throws std::runtime_error if there would be more than 50 million cells
LabelGrid label_cells(const Volume& volume, const Labels& labels);

/// Leaves the piece of the body that Labels::keep asks for.
/// @throws std::runtime_error if no cell is left, if the seed is in none, or if Keep::all finds several
/// pieces
void keep_piece(LabelGrid& grid, const Labels& labels);

/// The mesh of the cells that have a class, whose names are in group_of_cell.
/// @throws std::runtime_error if a class has no cell
Mesh mesh_of(const LabelGrid& grid, const Labels& labels);

/// A grid in bytes that anybody may have made; bytes_of() makes them.
/// @throws std::exception if they hold no grid, or one with a class that does not exist
LabelGrid label_grid_from(const std::string& bytes, std::size_t n_classes);
std::string bytes_of(const LabelGrid& grid);

/// Reads the file in a confined process, and keeps one piece.
/// @throws InputError, at the place of the file in the case file, with the reason
LabelGrid read_label_grid(const Labels& labels);
/// Makes the mesh of the grid that read_label_grid() reads.
Mesh make_label_mesh(const Labels& labels);

/// How a picture lies in the world, at the body's scale. Read in a confined process.
/// @throws InputError, at the place of the file in the case file, if it has no such map, or one that is no
/// rotation
Placement placement_of(const Labels& labels);

/// The same body, with its crop and the point of the piece that is kept in the body's own coordinates.
Labels on_grid(const Labels& labels, const Placement& placement);

/// The intensities of the voxels whose centre lies in a body's grid. Where the centre lies neither in one of
/// the body's cells nor in a neighbour of one, intensities above the level are mirrored below it. So the
/// contour at the level is the body's alone, as the picture has it, which cells follow in steps.
Picture picture_about(const Volume& volume, const LabelGrid& grid, double edge, double level);

/// The surface of a body made of a picture: the outer contour at an intensity around the piece that the body
/// keeps, closed by the sides of the crop. Read and made in a confined process.
/// @throws std::runtime_error as read_label_grid(), and if there is no contour
TriangleMesh label_surface(const Labels& labels, const PictureContour& contour);

} // namespace springproof::cases
