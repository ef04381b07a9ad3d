#pragma once

#include "cases/case/solution.hpp"
#include "cases/mesh/mesh.hpp"
#include "cases/mesh/mesh_file.hpp"
#include "cases/mesh/triangle_mesh.hpp"

/// VTK's readers and writers for callers that include none of VTK's headers.
namespace springproof::cases {

/// Values at every node or of every cell.
template<class Value>
struct NamedValues {
  std::string name;
  std::vector<Value> values;
  std::string unit{}; ///< VTK's UNITS_LABEL; empty: none
};
using PointField = NamedValues<Eigen::Vector3d>;

/// The points of a VTK file and their vectors in the file's order; a point that several pieces share occurs
/// several times.
struct PointCloud {
  std::vector<Eigen::Vector3d> points;
  bool is_single_precision = false; ///< the points, in the file; those of images are multiples of a spacing
  std::vector<PointField> fields;   ///< point data of three components in single or double precision
  std::vector<std::string> others;  ///< data that are no such fields: the name, and what they are
};

/// Values at positions from values at points: at position p the sum of weights[i] times the value at
/// points[i], first[p] <= i < first[p + 1].
struct Interpolation {
  std::vector<std::size_t> first; ///< one more than there are positions
  std::vector<int> points;
  std::vector<double> weights;
  std::vector<double> outside; ///< for every position, how far outside of all cells it lies, mm; it takes the
                               ///< value of the closest place
  std::vector<Eigen::Vector3d> of(const std::vector<Eigen::Vector3d>& values) const {
    std::vector<Eigen::Vector3d> result(outside.size(), Eigen::Vector3d::Zero());
    for (std::size_t p = 0; p < result.size(); ++p)
      for (std::size_t i = first[p]; i < first[p + 1]; ++i)
        result[p] += weights[i] * values[static_cast<std::size_t>(points[i])];
    return result;
  }
};

/// A point cloud whose cells interpolate between its points.
struct CellCloud {
  PointCloud cloud;
  Interpolation to_nodes;   ///< from the cloud's points to the nodes of a mesh
  Interpolation from_nodes; ///< from the nodes of the mesh to the cloud's points
};

/// Intensities of a picture in three dimensions. Voxel (i, j, k) reaches from (i, j, k) * spacing to
/// (i + 1, j + 1, k + 1) * spacing: where a file places or turns its array in a scanner is left out.
struct Volume {
  std::array<int, 3> voxels{};      ///< along x, y, z, > 0
  Eigen::Vector3d spacing{1, 1, 1}; ///< mm, > 0
  std::vector<float> intensities;   ///< x fastest
};

/// How a picture's array lies in the world: point (x, y, z) of a Volume is at
/// corner + x axes[0] + y axes[1] + z axes[2].
struct Placement {
  std::array<Eigen::Vector3d, 3> axes{}; ///< unit vectors at right angles, right-handed
  Eigen::Vector3d corner{0, 0, 0};       ///< mm
  bool is_by_sform = true;               ///< NIfTI's sform says so, else its qform
  int code = 0;                          ///< that form's, > 0

  /// A direction of the world, along the axes of the array.
  Eigen::Vector3d turned(const Eigen::Vector3d& direction) const {
    return {axes[0].dot(direction), axes[1].dot(direction), axes[2].dot(direction)};
  }
  Eigen::Vector3d to_body(const Eigen::Vector3d& point) const { return turned(point - corner); }
};

/// What a picture's file can hold.
struct VolumeBytes {
  std::uint64_t in_file;
  std::uint64_t of_voxels; ///< deflate makes at most 1032 bytes from one
  bool is_compressed;      ///< by gzip, from the first byte on
};

/// A number at every point of a regular grid, such as the mask of a body or the density of a tissue.
struct Picture {
  std::array<int, 3> n_points;     ///< along x, y, z, > 0
  Eigen::Vector3d origin, spacing; ///< mm: the first point, and the way from one to the next
  std::vector<float> values;       ///< x fastest

  float largest() const { return *std::max_element(values.begin(), values.end()); }
};

struct ContourSettings {
  double level = 0.5;
  int n_smoothing = 0; ///< passes of VTK's windowed sinc filter, which takes the steps of a mask and shrinks
                       ///< little; 0: as the picture has it
  std::size_t n_triangles = 0; ///< at most about so many, by quadric decimation; 0: all
  bool has_one_piece = false;  ///< only the piece with the most triangles
};

/// The cell of a body at rest that holds a point or is nearest to it.
struct PlaceInCell {
  std::size_t cell;
  Eigen::Vector3d nearest; ///< mm: the point itself in the cell (to 1e-3 of its edge), else one on its faces
};

/// What a grid carries.
struct GridFields {
  std::vector<PointField> point_vectors{};
  std::vector<NamedValues<double>> point_numbers{};
  std::vector<NamedValues<double>> cell_numbers{};
  std::vector<NamedValues<SymmetricTensor>> cell_tensors{};
};

/// The functions of the shared object springproof_vtk. They throw std::runtime_error with VTK's message.
struct VtkFunctions {
  /// Content of a .vtu: doubles, appended raw.
  std::string (*write_unstructured_grid)(const Mesh&, const GridFields&);
  /// The same with lines between points as cells.
  std::string (*write_lines)(const std::vector<Eigen::Vector3d>& points,
                             const std::vector<std::array<int, 2>>& lines, const GridFields&);
  /// Content of a file .vtu, .vtp, .vts, .vtr, .vti or .vtk, in any encoding.
  PointCloud (*read_points)(const std::string& content);
  /// The same with its cells as interpolation to a mesh and back. A node of the mesh may lie outside of all
  /// cells by half the diagonal of the closest.
  CellCloud (*read_cells)(const std::string& content, const Mesh& mesh);
  /// Points and cells of a file .vtu or .vtk. Whole numbers of the cells are their groups: those of the name
  /// `groups`; without one, those of a name that programs give them, or the only ones.
  MeshFileContent (*read_mesh)(const std::string& content, const std::string& groups);
  /// Reads a file .stl, text or binary, .obj or .ply, whose coordinates VTK takes in single precision, or
  /// .vtp.
  Surface (*read_triangles)(const std::string& path);
  /// The index of the point closest to each position.  @param points  at least one
  std::vector<std::size_t> (*nearest_points)(const std::vector<Eigen::Vector3d>& points,
                                             const std::vector<Eigen::Vector3d>& positions);
  /// Reads a file .nii, .nii.gz or .inv3.
  /// @param bytes  what the file can hold; a compressed one is inflated twice, to check it first
  Volume (*read_volume)(const std::string& path, const VolumeBytes& bytes);
  /// Reads the header of a file .nii or .nii.gz.
  Placement (*read_placement)(const std::string& path);
  /// cases::contour() for as many values as points.
  Surface (*contour)(const Picture&, const ContourSettings&);
  /// The place nearest to each position.  @param mesh  with at least one cell
  std::vector<PlaceInCell> (*nearest_in_cells)(const Mesh& mesh,
                                               const std::vector<Eigen::Vector3d>& positions);
  /// cases::decimated()
  Surface (*decimated)(const TriangleMesh&, std::size_t n_triangles);
  /// How far points are from a surface, mm; < 0: on its inner side.  @param surface  with a triangle or more
  std::vector<double> (*distances)(const TriangleMesh& surface, const std::vector<Eigen::Vector3d>& points);
};

/// For commands that need VTK after they have solved.
/// @throws InputError where the program was built without VTK, with what to type
void check_has_vtk();

/// Loads the shared object springproof_vtk at the first call. Linked to the programs, VTK's libraries would
/// lengthen every start by a fifth.
/// @throws InputError as check_has_vtk()
const VtkFunctions& vtk();

/// The symbol by which vtk() finds them.
extern "C" const VtkFunctions springproof_vtk;

// VTK's readers and filters in a confined process: they crash on some broken files, and allocate whatever a
// file says that it has.

/// Reads a file .stl, text or binary, .obj or .ply; coordinates are rounded to single precision. Anything
/// after a binary STL's last triangle, and a triangle that is there twice, are left out.
/// @param remarks  receives what was left out, and how many triangles have no area
/// @throws std::runtime_error with VTK's message; if the file has no triangles or a position that is not
/// finite
Surface read_triangles(const std::string& path, std::vector<std::string>* remarks = nullptr);

/// @param content  the content of a file .vtu, .vtp, .vts, .vtr, .vti or .vtk
/// @throws std::runtime_error with VTK's message; if it has no points
PointCloud read_point_cloud(const std::string& content);

/// The same with interpolation between its points and the nodes of a mesh.
/// @throws std::runtime_error likewise; if it has no cells of a volume, or none near a node of the mesh
CellCloud read_cell_cloud(const std::string& content, const Mesh& mesh);

/// The triangles of read_triangles(), which share their vertices. They need not be closed.
/// @param remarks  as in read_triangles()
/// @throws std::runtime_error with VTK's message; if it has no triangles or a position that is not finite
TriangleMesh read_surface(const std::string& path, std::vector<std::string>* remarks = nullptr);

/// The surface that divides a picture's points with a value above the level from the others: closed, because
/// beyond its borders a picture is below the level; seen from outside anticlockwise, outside being below.
/// @throws std::runtime_error if there is none; if the sizes of the picture are not as many as its values
TriangleMesh contour(const Picture& picture, const ContourSettings& settings);

/// Reduces a surface with more triangles to about so many, by quadric decimation, in 20 s or not at all.
/// @throws std::runtime_error with VTK's message; if it takes longer, or no triangle is left
TriangleMesh decimated(const TriangleMesh& surface, std::size_t n_triangles);

/// Values in the bytes that a confined process answered, which may be anything; bytes_of() makes them.
/// @throws std::exception if the bytes are no such value: a field of another length than the points, no
/// triangles, a position that is not finite, a weight of a point that does not exist
Surface surface_from(const std::string& bytes);
PointCloud point_cloud_from(const std::string& bytes);
CellCloud cell_cloud_from(const std::string& bytes, std::size_t n_nodes);
std::string bytes_of(const Surface& surface);
std::string bytes_of(const PointCloud& cloud);
std::string bytes_of(const CellCloud& cloud);

} // namespace springproof::cases
