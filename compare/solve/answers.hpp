#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "msm/design/design.hpp"

namespace springproof::compare {

/// One model's answer to a case, and what it took. Wall-clock seconds.
struct Answer {
  cases::Solution solution;
  double setup_seconds = 0; ///< design, mesh, degrees of freedom, pattern
  double solve_seconds = 0; ///< from rest to equilibrium
  double seconds() const { return setup_seconds + solve_seconds; }
  bool converged() const { return solution.status == cases::Status::converged; }
};

/// Another program's answer to the finite elements' question.
struct Peer {
  std::string program;
  Answer answer; ///< skipped when the program is absent or cannot express the case
  /// Largest difference of a node's displacements (finite elements, peer) over the largest displacement.
  std::optional<double> largest_difference;
};

/// The finite elements on uniformly refined meshes, the case's own among them, from coarse to fine.
struct RefinedMeshes {
  std::vector<int> refine;                ///< refinements of the body's mesh, ascending
  std::vector<cases::Solution> solutions; ///< one for each
  std::string reason; ///< why there are none or no more; empty when all that were tried are there
};

/// How results on a mesh of their own came to the nodes of the case's mesh: another program's, or beside a
/// network those of the finite elements.
struct Interpolated {
  cases::Side side = cases::Side::msm; ///< whose results they are
  std::size_t n_points = 0;            ///< points of the results
  std::size_t n_outside = 0;   ///< nodes outside of the results' cells, with the value of the closest place
  double largest_distance = 0; ///< distance of the farthest of them, mm
  /// The finite elements' displacement, interpolated to the results' points and back to the nodes: what two
  /// interpolations lose estimates what one has lost. Beside a network, the displacement interpolated by
  /// quadratic functions. Skipped where the finite elements failed.
  Answer fem_and_back;
};

/// All that solving a case has found: the answers of solve(), complete and not changed afterwards. Of the
/// same finite elements and other springs, other answers are made: with_displacements(), rank_designs().
struct Answers {
  cases::Fem resolved;              ///< [fem] with what "auto" was found to mean
  std::vector<std::string> choices; ///< what "auto" in [fem] was taken to mean, with the reasons
  Answer fem, msm;
  std::string msm_source; ///< file with another program's displacements in place of our springs'; empty: ours
  std::string msm_name = "springs"; ///< heading of these values in text: the file's or the client's name
  std::optional<msm::DesignResult> design; ///< absent when the springs were skipped or could not be designed
  std::optional<RefinedMeshes> refined;    ///< meshes of the finite elements' limit, if asked for
  std::optional<Peer> peer;                ///< when asked for
  std::optional<Interpolated> interpolated{}; ///< the side that was interpolated
  std::vector<std::string> msm_warnings{};    ///< what msm_source does and no answer to the case would

  /// A side that was asked for did not converge.
  bool failed() const {
    const auto is_failed = [](const Answer& a) { return a.solution.status == cases::Status::failed; };
    return is_failed(fem) || is_failed(msm) || (peer && is_failed(peer->answer));
  }
};

/// All solutions among the answers, in an order that depends on which there are alone.
inline std::vector<cases::Solution*> solutions_of(Answer& answer) {
  return {&answer.solution};
}
inline std::vector<cases::Solution*> solutions_of(Answers& answers) {
  std::vector<cases::Solution*> all{&answers.fem.solution, &answers.msm.solution};
  if (answers.peer) all.push_back(&answers.peer->answer.solution);
  if (answers.interpolated) all.push_back(&answers.interpolated->fem_and_back.solution);
  if (answers.refined)
    for (cases::Solution& solution : answers.refined->solutions) all.push_back(&solution);
  return all;
}

/// What is asked of a case, besides what its file says.
struct Request {
  std::optional<cases::Side> only; ///< absent: both sides
  int meshes = 0;                  ///< meshes of the finite elements' limit; 0: as [fem] accuracy asks
  std::string peer{};              ///< a program that is asked too; empty: none
  int n_threads = 1;               ///< threads of the springs' multigrid path; numbers do not depend on it
  bool asks(cases::Side side) const { return !only || *only == side; }
};

/// A case's scene and what is asked of it: all that answers depend on.
struct Question {
  cases::Scene scene;
  Request request;
};

} // namespace springproof::compare
