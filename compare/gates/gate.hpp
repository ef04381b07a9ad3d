#pragma once

#include "compare/gates/comparison.hpp"

#include <string>
#include <vector>

/// Expectations as gates: what a continuous-integration server is told.
namespace springproof::compare {

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

/// The gates of a case, and what failed as a whole. Never met are: an expectation of a measure that is not
/// there, or has no finite value; a case that expects nothing; a case of which a solve has failed.
GatedCase judge_gates(const Comparison& comparison);

bool all_met(const std::vector<GatedCase>& cases);

/// Why a gate is not met; empty when it is.
std::string reason_of(const Gate& gate);

/// A gate in words: "alpha_1 error_percent = -4.98 % in [-6.44, -3.38]", or with the reason why not.
std::string describe(const Gate& gate);

/// The error bar in words, " (reference +- 0.21 %)", or nothing.
std::string describe_uncertainty(const Gate& gate);

} // namespace springproof::compare
