#pragma once

#include "compare/thesis/results.hpp"

#include <nlohmann/json_fwd.hpp>

namespace springproof::compare {

/// The document of `tables --json`. No times, dates or machine's name: the same commit writes the same bytes.
nlohmann::ordered_json results_to_json(const ThesisResults& results);

} // namespace springproof::compare
