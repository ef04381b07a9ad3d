#pragma once

#include "compare/peers/displacement_file.hpp"
#include "compare/solve/answers.hpp"

/// Displacements that another simulator computed, in place of our springs'.
namespace springproof::compare {

/// Reads a file by its ending, .csv or .vtu.
/// @throws InputError as the two formats' readers, or if it has another ending
std::vector<GivenDisplacement> read_displacements(const std::string& path);

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
/// iterations, for none are known. Collective.
Answers with_displacements(Answers answers, const cases::HexMesh& mesh,
                           const ExternalDisplacements& external);

} // namespace springproof::compare
