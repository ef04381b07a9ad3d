#pragma once

#include "compare/study/study.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace springproof::compare {

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
