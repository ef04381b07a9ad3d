#pragma once

#include "compare/hard/stress.hpp"
#include "compare/table/json.hpp"

#include <ostream>

namespace springproof::compare {

/// A case's name and sentence, one line per model, and what differs.
void write_stress_text(std::ostream& out, const StressResult& result);

/// Which cases were left out, and how many of the others ended as expected.
/// @param skipped  names of heavy cases that were not asked for
void write_stress_summary(std::ostream& out, const std::vector<StressResult>& results,
                          const std::vector<std::string>& skipped);

/// The document of `stress --json`.
Json stress_to_json(const std::vector<StressResult>& results, const std::vector<std::string>& skipped);

} // namespace springproof::compare
