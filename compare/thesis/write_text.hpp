#pragma once

#include "compare/thesis/results.hpp"

#include <ostream>

namespace springproof::compare {

enum class Commands { one_per_table, all };

/// The tables as in print, a row per measure and a column per variant; then designs, volumes, advice and the
/// summary. No times, dates or machine's name: the same commit writes the same bytes.
void write_tables_text(std::ostream& out, const ThesisResults& results, Commands commands);

} // namespace springproof::compare
