#pragma once

#include "cases/mesh/vtk_functions.hpp"
#include "compare/gates/comparison.hpp"
#include "msm/spring.hpp"

#include <ostream>

/// Files for ParaView: fields on the body's mesh, and springs as lines.
namespace springproof::compare {

/// Both models on the body's mesh at rest, so that "warp by vector" overlays them. Each side that
/// converged has, as `fem_` and `msm_`:
///   at nodes  displacement (mm), reaction (N);
///   in cells  cell_volume (mm³), inverted (0 or 1), stress (Cauchy, MPa), von_mises (MPa), strain
///             (logarithmic), strain_energy_density (N mm per mm³ at rest).
/// Both give difference (vector, springs less finite elements, mm), error (its length, mm), relative_error
/// (over the finite elements' largest displacement) and von_mises_difference (MPa), the case gives
/// applied_force (N, at nodes, full load; not where a load follows a history), material (number of the cell's
/// [[region_material]], 0: the body's own). Stress, strain and reactions are there when the solutions have
/// fields, stress and energy when their springs belong to cells.
///
/// Ranks that share the answers have the nodes and cells that are here; the names are the same on every rank.
/// Collective.
cases::GridFields grid_fields_of(const Comparison& comparison);

/// The ranks that share a comparison's answers; null: all of them is here.
const cases::Sharing* sharing_of(const Comparison& comparison);

/// The body's mesh at rest with grid_fields_of() the comparison as a VTK unstructured grid (.vtu, doubles,
/// raw binary), for ParaView. Every array carries its unit as VTK's UNITS_LABEL; tensors have the components
/// XX, YY, ZZ, XY, YZ, XZ. All of the answers is here: no ranks share them.
void write_vtu(std::ostream& out, const Comparison& comparison);

/// Any vectors on a mesh's nodes as a .vtu.
void write_vtu(std::ostream& out, const cases::HexMesh& mesh, const std::vector<cases::PointField>& fields);

/// Removes FOLDER/NAME_NUMBER.vtu of this number and above, of an earlier run, and the folder if nothing is
/// left.
void remove_numbered(const std::string& folder, const std::string& name, int first);

/// The same as files: FOLDER/NAME.vtu or, where ranks share the answers, FOLDER/NAME_pieces/NAME_RANK.vtu and
/// FOLDER/NAME.pvtu, which is written when its pieces are whole; and FOLDER/NAME_springs.vtu, the springs as
/// lines, where has_drawn_springs(). What other numbers of ranks have left is removed. Every rank calls it.
/// @throws InputError if a file cannot be written
void write_fields(const std::string& folder, const Comparison& comparison);

/// Springs as lines between points.
struct SpringLines {
  std::vector<std::array<int, 2>> ends;
  std::vector<double> stiffness;   ///< at rest, N/mm
  std::vector<double> rest_length; ///< mm

  void add(int i, int j, const msm::Spring& spring) {
    ends.push_back({i, j});
    stiffness.push_back(spring.stiffness);
    rest_length.push_back(spring.rest_length);
  }
};

/// The lines as a VTK unstructured grid (.vtu, doubles, raw binary), with their stiffness and rest_length.
/// @param points  at rest, mm    @param others  further fields of the points and the lines
std::string vtu_of_lines(const std::vector<Eigen::Vector3d>& points, const SpringLines& lines,
                         cases::GridFields others);

/// Cells of a body up to which its springs are drawn: 2 million lines, 150 MB.
constexpr std::size_t most_cells_with_springs = 150000;

/// Whether the springs' side converged with springs of ours, and the body is not too large.
bool has_drawn_springs(const Comparison& comparison);

/// Springs as lines of a VTK unstructured grid (.vtu, doubles, raw binary): stretch (deformed over rest
/// length), tension (N, below 0 when pressed), stiffness at rest (N/mm), rest_length (mm), and at points
/// msm_displacement (mm). Springs of one law that cells share are one line; so are edges that biquadratic
/// tetrahedra share, whose tension also follows the other edges of the tetrahedron.
/// @param comparison    one for which has_drawn_springs() holds
/// @param displacement  displacement of the springs, mm, on all nodes, whoever shares them
void write_springs_vtu(std::ostream& out, const Comparison& comparison,
                       const std::vector<Eigen::Vector3d>& displacement);

} // namespace springproof::compare
