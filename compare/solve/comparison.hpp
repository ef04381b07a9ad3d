#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "compare/error_bars/mesh_study.hpp"
#include "msm/design/design.hpp"

#include <optional>
#include <string>
#include <vector>

namespace springproof::compare {

/// One model's answer to a case, and what it took. Wall-clock seconds.
struct Side {
  cases::Solution solution;
  double setup_seconds = 0; ///< design, mesh, degrees of freedom, pattern
  double solve_seconds = 0; ///< from rest to equilibrium
};

/// A measure on both sides. A side that failed or was skipped has no value.
struct MeasuredValue {
  std::string name;
  std::string unit;
  std::optional<double> fem;
  std::optional<double> msm;
  std::optional<double> error_percent;
  std::optional<double> peer = std::nullopt; ///< by another program, when it was asked
};

/// Another program's answer to the finite elements' question.
struct Peer {
  std::string program;
  Side side; ///< skipped when the program is absent or cannot express the case
  /// Largest distance of a node's two displaced positions (finite elements, peer) over the largest
  /// displacement.
  std::optional<double> largest_difference;
};

enum class Verdict { met, missed };

/// An expectation held against what was measured. What cannot be measured is missed, with the reason.
struct Judgement {
  cases::Expectation expectation;
  Verdict verdict;
  std::optional<double> value;
  std::string reason; ///< empty when met
};

/// Everything known of a case after it was run: one plain record, which the writers read.
struct Comparison {
  cases::Scene scene;
  Side fem;
  Side msm;
  std::string msm_source; ///< file with another program's displacements in place of our springs'; empty: ours
  std::optional<msm::DesignResult>
      design;                       ///< absent when the mass-spring side was skipped or could not be designed
  std::vector<std::string> choices; ///< what "auto" in [fem] was taken to mean, with the reasons
  std::vector<MeasuredValue> measures;
  std::vector<Judgement> judgements;
  std::optional<MeshStudy> mesh_study; ///< when asked for
  std::optional<Peer> peer;            ///< when asked for
  bool failed() const;                 ///< a side that was asked for did not converge
};

enum class Only { both, fem, msm };

/// Solves both sides of a case, or the one asked for, and measures them. A solve that fails is a failed side.
/// Collective over MPI_COMM_WORLD; the mass-spring side is solved on rank 0 alone.
/// @throws InputError
Comparison compare_case(const cases::Case& definition, Only only = Only::both);

/// Measures a comparison's sides and judges the case's expectations by that; what was there before goes.
void measure_sides(Comparison& comparison);

/// Asks CalculiX about a comparison's case, and puts its answers beside the others.
void ask_calculix(Comparison& comparison);

/// @param measures  of the same case
Judgement judge(const cases::Expectation& expectation, const std::vector<MeasuredValue>& measures);

} // namespace springproof::compare
