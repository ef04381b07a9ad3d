#pragma once

#include "cases/mesh/vtk_functions.hpp"
#include "compare/solve/answers.hpp"

#include <functional>

/// Displacements that another simulator computed: as they stand in a file, and in place of our springs'.
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

/// Rows of finite numbers beneath a header, for it and for motions.
/// @param row_of  takes a row's numbers and its "file:line"
/// @throws InputError, likewise
void read_displacement_rows(
    const std::string& text, const std::string& path, const std::string& header,
    const std::function<void(const std::vector<double>&, const std::string&)>& row_of);

/// A VTK file (read_point_cloud()); among its point data an array of three components in single or double
/// precision, named msm_displacement or displacement, or the only one with three. Points with the same
/// position and displacement are one node.
/// @param array  its name instead; empty: as above   @throws InputError, likewise
std::vector<GivenDisplacement> read_displacement_vtk(const std::string& text, const std::string& path,
                                                     const std::string& array = {});
/// The same of what VTK has read.
std::vector<GivenDisplacement> displacements_in(const cases::PointCloud& cloud, const std::string& path,
                                                const std::string& array = {});

/// Displacements (mm) at the points of a VTK file, in its order.
/// @throws InputError, likewise
const std::vector<Eigen::Vector3d>&
finite_displacements(const cases::PointCloud& cloud, const std::string& path, const std::string& array = {});

/// Distance (mm) within which a given node stands for a node of the mesh, besides the rounding of its
/// position: 1e-6 of the diagonal of the mesh's bounding box, which six digits keep near the origin.
double same_place(const cases::Mesh& mesh);

/// Displacements in the order of the mesh's nodes, matched by position.
/// @throws InputError if a given node lies at no node of the mesh, or a node is given twice or not at all
std::vector<Eigen::Vector3d> match_nodes(const cases::Mesh& mesh, const std::vector<GivenDisplacement>& given,
                                         const std::string& path);

/// Reads a file by its ending: .csv, or one of VTK's.
/// @param array  for VTK's reader   @throws InputError as the two formats' readers, or if it has another
/// ending
std::vector<GivenDisplacement> read_displacements(const std::string& path, const std::string& array = {});

/// @throws InputError that a .csv has no arrays
[[noreturn]] void refuse_array(const std::string& path);

/// How results come to the nodes of the case's mesh.
enum class Transfer {
  matched,     ///< every node is one of the results' points
  interpolated ///< in the results' cells
};

/// Another simulator's answer to a case.
struct ExternalDisplacements {
  std::string path;
  cases::Solution solution;                   ///< converged; of a case with [dynamics] a motion
  std::optional<cases::CellCloud> cells = {}; ///< between which it was interpolated
};

/// Checks that displacements alone tell every measure of a case.
/// @param option  that brings them, for messages
/// @throws InputError at a measure of stress, strain or forces
void check_displacements_suffice(const cases::Case& definition, const std::string& option);

/// Reads `--msm-displacements` for the one case that it belongs to, before anything is solved.
/// @param path  of a case with [dynamics] a motion's; empty: there are none
/// @param array  the name of the displacements in a VTK file; empty: the reader's choice
/// @throws InputError as read_displacements(), read_motion() and match_nodes(), or if there are several
/// cases; of results to be interpolated, if the file has no cells, a node of the mesh lies far from all of
/// them, or they are a motion; of a motion on several ranks
std::optional<ExternalDisplacements> read_external(const std::vector<Question>& questions,
                                                   const std::string& path, Transfer transfer,
                                                   const std::string& array = {});

/// What a case says to displacements that another program gives as an answer to it.
struct HeldAgainstCase {
  std::string message; ///< how far they are from an equilibrium of the case's springs; empty: there are none
  std::vector<std::string> warnings; ///< what no answer to the case does
};

/// Looks whether supports hold and moved regions are where the case moves them, to 1 % of the largest
/// displacement, and what the case's springs and loads say: |g - F| / |F| on free degrees of freedom, g the
/// gradient of the springs' energy, and |(g - F) . u|, over the larger one of |F . u| and the springs' whole
/// g . u. Finite elements of the same body leave most of the first, and of the second what their stiffness
/// differs by; half of it is left by displacements in other axes, in metres, or under another load.
/// A motion is held against the supports at its end alone.
/// @param displacement  mm, one per node; a motion's at its end
HeldAgainstCase hold_against_case(const cases::Scene& scene,
                                  const std::vector<Eigen::Vector3d>& displacement);

/// The answers with another simulator's in place of our springs', held against the case. They have no
/// stiffness and no counts of iterations, for none are known. Collective.
Answers with_displacements(Answers answers, const cases::Scene& scene, const ExternalDisplacements& external);

} // namespace springproof::compare
