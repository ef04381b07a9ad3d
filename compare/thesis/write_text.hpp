#pragma once

#include "compare/thesis/regenerate.hpp"
#include "compare/thesis/sheets.hpp"

#include <ostream>

namespace springproof::compare {

/// The tables as in print: measures down, Poisson's ratios across, each value with its difference from print
/// beside it. Then the counts and the design to use, on a few screens of screen_width characters. No times,
/// dates or machine's name: the same commit writes the same bytes.
void write_tables_text(std::ostream& out, const ThesisResults& results);

/// Where the audit of each figure is.
/// @param folder  of `--out`; empty: none was given, and what to type is told
void write_where_text(std::ostream& out, const ThesisResults& results, const std::string& folder);

/// Published values by what became of them. One that failed has no value against some reference.
struct EntryCounts {
  int n = 0, n_reproduced = 0, n_failed = 0;
  int n_not_reproduced() const { return n - n_reproduced - n_failed; }
};
EntryCounts count_entries(const std::vector<TableEntry>& entries);

} // namespace springproof::compare
