#pragma once

#include "compare/peers/displacement_file.hpp"
#include "compare/solve/answers.hpp"

/// Displacements that another simulator computed, in place of our springs'.
namespace springproof::compare {

/// Reads a file by its ending: .csv, or one of VTK's.
/// @throws InputError as the two formats' readers, or if it has another ending
std::vector<GivenDisplacement> read_displacements(const std::string& path);

/// How results come to the nodes of the case's mesh.
enum class Transfer {
  matched,     ///< every node is one of the results' points
  interpolated ///< in the results' cells
};

/// Another simulator's answer to a case.
struct ExternalDisplacements {
  std::string path;
  std::vector<Eigen::Vector3d> displacement;  ///< mm, one per node of the case's mesh
  std::optional<cases::CellCloud> cells = {}; ///< between which it was interpolated
};

/// Reads `--msm-displacements` for the one case that it belongs to, before anything is solved.
/// @param path  empty: there are none
/// @throws InputError as read_displacements() and match_nodes(), or if there are several cases; of results to
/// be interpolated, if the file has no cells or a node of the mesh lies far from all of them
std::optional<ExternalDisplacements> read_external(const std::vector<Question>& questions,
                                                   const std::string& path, Transfer transfer);

/// The answers with another simulator's in place of our springs', held against the case. They have no
/// stiffness and no counts of iterations, for none are known. Collective.
Answers with_displacements(Answers answers, const cases::Scene& scene, const ExternalDisplacements& external);

} // namespace springproof::compare
