#pragma once

#include "cases/scene/scene.hpp"
#include "compare/peers/displacement_file.hpp"
#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// How near a given node must lie to the node of the case's mesh that it stands for, mm.
constexpr double same_place = 1e-6;

/// Displacements in the order of the mesh's nodes, matched by position.
/// @throws InputError if a given node lies at no node of the mesh, if one is given twice, or if one is not
/// given
std::vector<Eigen::Vector3d>
match_nodes(const cases::HexMesh& mesh, const std::vector<GivenDisplacement>& given, const std::string& path);

/// Another simulator's answer to a case.
struct ExternalDisplacements {
  std::string path;
  std::vector<Eigen::Vector3d> displacement; ///< mm, one per node of the case's mesh
};

/// Reads `--msm-displacements` for the one case that it belongs to, before anything is solved.
/// @param path  empty: there are none
/// @throws InputError as read_displacements() and match_nodes(), or if there are several cases
std::optional<ExternalDisplacements> read_external(const std::vector<Question>& questions,
                                                   const std::string& path);

/// The answers with another simulator's in place of our springs'. They have no stiffness and no counts of
/// iterations, for none are known.
Answers with_displacements(Answers answers, const cases::HexMesh& mesh,
                           const ExternalDisplacements& external);

} // namespace springproof::compare
