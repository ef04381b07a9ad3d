#pragma once

#include "compare/gates/comparison.hpp"

#include <optional>
#include <string>
#include <vector>

/// Expectations as gates: what a continuous-integration server is told.
namespace springproof::compare {

/// An expectation of a case, judged, and what the reader of the verdict must know besides.
struct Gate {
  Judgement judgement;
  std::string unit; ///< of the interval and the value: "%", "mm", "deg", "mm3"
  /// Half the width of the reference's own error bar from its mesh study, in the unit: shown, and added to
  /// neither side. Absent where there is none, and for the springs' own value, which has no reference.
  std::optional<double> uncertainty;
  std::string warning; ///< such as that the interval is narrower than the error bar; empty: none
  bool met() const { return judgement.verdict == Verdict::met; }
};

/// A case with all its gates.
struct GatedCase {
  std::string name, file;
  std::vector<Gate> gates;
  std::vector<std::string> failures; ///< of the case as a whole: it expects nothing, a solve failed
  bool met() const;
};

/// Whether a case asks for the reference's error bar by itself: an expectation against a converged reference
/// does.
bool asks_for_mesh_study(const cases::Case& definition);

/// Judges every expectation by what was measured. Never met are: an expectation of a measure that is not
/// there, or has no finite value; a case that expects nothing; a case of which a solve has failed.
GatedCase judge_gates(const Comparison& comparison);

bool all_met(const std::vector<GatedCase>& cases);

/// A gate in words: "alpha_1 error_percent = -4.98 % in [-6.44, -3.38]", or with the reason why not.
std::string describe(const Gate& gate);

/// The error bar in words, " (reference +- 0.21 %)", or nothing.
std::string describe_uncertainty(const Gate& gate);

} // namespace springproof::compare
