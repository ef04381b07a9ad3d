#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/labels.hpp"
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

/// The intensities about a body: those of the voxels whose centre lies in the grid. Where it does neither in
/// a cell of the body nor in a neighbour of one, intensities above the level are as far below it, so that the
/// contour at the level is that of the body alone, as the picture has it, which cells follow in steps.
Picture picture_about(const Volume& volume, const LabelGrid& grid, double edge, double level);

/// The surface of a body made of a picture: its contour at an intensity, of the piece that the body keeps,
/// the outer one alone; closed by the sides of the crop. Read and made in a confined process.
/// @throws std::runtime_error as read_label_grid(), and if there is no contour
TriangleMesh label_surface(const Labels& labels, const PictureContour& contour);

} // namespace springproof::cases
