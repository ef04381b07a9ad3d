#pragma once

#include "compare/study/study.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

/// Rankings as text, CSV and JSON; what a run or a ranking comes to, in words, and what its reader may type
/// next.
namespace springproof::compare {

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

/// A table of the designs in at most 100 columns, those without an error with the reason, the case's
/// expectations; last the advice.
void write_ranking_text(std::ostream& out, const Ranking& ranking);

/// One row per case and design, with its springs.
void write_ranking_csv(std::ostream& out, const std::vector<Ranking>& rankings);

/// A case of the document below.
nlohmann::ordered_json ranking_to_json(const Ranking& ranking);

/// The document of `run --designs --json`: {"schema", "cases": [...]}
nlohmann::ordered_json rankings_to_json(const std::vector<Ranking>& rankings);

/// Writes ranking.txt, ranking.csv and ranking.json. Called after every case, so that what is finished is on
/// disk before the next begins.
void write_rankings(const std::string& folder, const std::vector<Ranking>& rankings);

} // namespace springproof::compare
