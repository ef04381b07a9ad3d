#pragma once

#include "cases/case/error.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <variant>
#include <vector>

/// [body] of a case file. Units: mm.
namespace springproof::cases {

SPRINGPROOF_ENUMERATION(Axis, x, y, z)

struct Box {
  Eigen::Vector3d size;     ///< mm, > 0; the box reaches from the origin to size
  std::array<int, 3> cells; ///< > 0
};
SPRINGPROOF_FIELDS(Box, size, cells)

/// A mesh of hexahedra or of tetrahedra: gmsh's (.msh) or VTK's (.vtu, .vtk), or a .geo that gmsh meshes on
/// the fly.
struct MeshFile {
  NamedFile file;
  double scale = 1;          ///< mm of a unit of the file
  std::string cell_groups{}; ///< name of the cell data whose values are the groups; empty: found by itself
};
SPRINGPROOF_FIELDS(MeshFile, file, scale, cell_groups)

/// What fills a closed surface.
SPRINGPROOF_ENUMERATION(Fill, tetrahedra, cubes)

/// A body whose closed surface (STL, OBJ, PLY, VTP) is filled with tetrahedra, or with cubes as Voxels.
struct FilledSurface {
  NamedFile file;
  double size; ///< mm, > 0: the tetrahedra's edges, about; the cubes' edges
  Fill fill = Fill::cubes;
  double scale = 1; ///< mm of a unit of the file
};
SPRINGPROOF_FIELDS(FilledSurface, file, size, fill, scale)

/// The cubes of a grid whose centres lie inside a closed surface (STL). The grid starts where the surface's
/// bounding box has its lower corner.
struct Voxels {
  NamedFile file;
  double edge;      ///< mm, > 0
  double scale = 1; ///< mm of a unit of the file
};
SPRINGPROOF_FIELDS(Voxels, file, edge, scale)

/// A class of voxels, and of the cells that they fill.
struct LabelClass {
  std::string name;    ///< unique; not the name of a face
  double lower, upper; ///< intensities, closed, lower <= upper
  bool is_rigid;       ///< bone: nodes of its cells are held unless something moves them; one class at most
};
SPRINGPROOF_FIELDS(LabelClass, name, lower, upper, is_rigid)

/// Which of the pieces that share no face is the body.
SPRINGPROOF_ENUMERATION(Keep,
                        all,     ///< there is but one
                        largest, ///< the one with the most cells
                        seed     ///< the one with a point
)

/// What a case's points and directions are given in.
SPRINGPROOF_ENUMERATION(Frame,
                        grid, ///< the body's own: mm along the axes of the picture's array, from its corner
                        world ///< the scanner's, to which the picture's file has a map
)

/// The cells of a picture in three dimensions (NIfTI, InVesalius) that are of some class.
struct Labels {
  NamedFile file;
  double edge;                                        ///< a cell's, mm, > 0
  std::vector<LabelClass> classes;                    ///< 1 to 255; the first that fits a voxel has it
  std::optional<std::array<Eigen::Vector3d, 2>> crop; ///< mm: two corners, the lower one first
  Keep keep = Keep::all;
  Eigen::Vector3d seed = Eigen::Vector3d::Zero(); ///< mm
  double scale = 1;                               ///< factor on the lengths in the file
  Frame frame = Frame::grid;
};
SPRINGPROOF_FIELDS(Labels, file, edge, classes, crop, keep, seed, scale, frame)

/// Nodes and the springs between them, without cells: read_nodes(), read_network().
struct Network {
  NamedFile nodes, springs; ///< CSV
};
SPRINGPROOF_FIELDS(Network, nodes, springs)

using Body = std::variant<Box, MeshFile, Voxels, Labels, FilledSurface, Network>;

/// Whether a body has volume, faces and a material.
inline bool has_cells(const Body& body) {
  return !std::holds_alternative<Network>(body);
}

inline bool is_in_world(const Body& body) {
  const Labels* labels = std::get_if<Labels>(&body);
  return labels != nullptr && labels->frame == Frame::world;
}

/// The class whose cells are rigid, if there is one.
inline const LabelClass* rigid_class(const Body& body) {
  const Labels* labels = std::get_if<Labels>(&body);
  if (labels == nullptr) return nullptr;
  const auto found = std::find_if(labels->classes.begin(), labels->classes.end(),
                                  [](const LabelClass& one) { return one.is_rigid; });
  return found == labels->classes.end() ? nullptr : &*found;
}

/// A piece that is cut out of the body: the cells whose centre lies in a box. Where its two sides along an
/// axis are joined (thesis section 6.1.3, the removing method), the upper one ends on the lower one.
struct Removed {
  Eigen::Vector3d lower, upper; ///< mm
  std::optional<Axis> join;     ///< absent: the cut stays open
  Where where;
};
SPRINGPROOF_FIELDS(Removed, lower, upper, join, where)

} // namespace springproof::cases
