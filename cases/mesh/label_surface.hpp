#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/triangle_mesh.hpp"
#include "cases/mesh/vtk_functions.hpp"

namespace springproof::cases {

struct LabelGrid;

/// The intensities about a body: those of the voxels whose centre lies in the grid. Where it does neither in
/// a cell of the body nor in a neighbour of one, intensities above the level are as far below it, so that the
/// contour at the level is that of the body alone, as the picture has it, which cells follow in steps.
Picture picture_about(const Volume& volume, const LabelGrid& grid, double edge, double level);

/// The surface of a body made of a picture: its contour at an intensity, of the piece that the body keeps,
/// the outer one alone; closed by the sides of the crop. Read and made in a confined process.
/// @throws std::runtime_error as read_label_grid(), and if there is no contour
TriangleMesh label_surface(const Labels& labels, const PictureContour& contour);

} // namespace springproof::cases
