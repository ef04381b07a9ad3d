#pragma once

#include "compare/study/study.hpp"

#include <ostream>
#include <string>
#include <vector>

/// What a run or a ranking comes to, in words, and what its reader may type next.
namespace springproof::compare {

/// "2.31", or "-" without a value.
std::string two_digits(const std::optional<double>& value);

/// "2.31 +- 0.4": the worst error with what the reference's uncertainty leaves of it.
std::string worst_text(const Trial& trial);

/// Which design to use: its numbers as the table has them, the finite elements' own error as far as it is
/// known, what the reference's uncertainty does not tell it from, and why it and not those.
std::string advice_of(const Ranking& ranking);

/// What a case's own springs come to, in a sentence: their worst errors, with the reference's uncertainty,
/// and the finite elements' own, of the measures whose limit is known; or why there is nothing to compare.
std::string verdict_of(const Comparison& comparison);

/// How long both models took, and which was faster; of a motion, whether a step keeps up with a screen. Empty
/// where no model was solved.
std::string time_of(const Comparison& comparison);

/// A command that answers what the run leaves open.
struct NextCommand {
  std::string line; ///< as typed
  std::string what; ///< in a few words
};

void write_next_commands(std::ostream& out, const std::vector<NextCommand>& next);

/// The end of a run's text: the verdict, the expectations that are not met, times, and commands.
void write_verdict_text(std::ostream& out, const Comparison& comparison,
                        const std::vector<NextCommand>& next);

} // namespace springproof::compare
