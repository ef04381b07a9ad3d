#pragma once

#include "compare/table/json.hpp"
#include "compare/thesis/regenerate.hpp"

#include <ostream>

/// Results as text and files. Unless a text says where they are, none has a time, a date or a machine's name:
/// the same commit writes the same bytes.
namespace springproof::compare {

/// The tables as in print: measures down, Poisson's ratios across, each value with its difference from print
/// beside it. Then the counts and the design to use, on a few screens of screen_width characters. No times,
/// dates or machine's name: the same commit writes the same bytes.
void write_tables_text(std::ostream& out, const ThesisResults& results);

/// Tells where the audit of each figure is.
/// @param folder  value of `--out`; empty: none was given, and what to type is told
void write_where_text(std::ostream& out, const ThesisResults& results, const std::string& folder);

/// Published values by what became of them. One that failed has no value against some reference.
struct EntryCounts {
  int n = 0, n_reproduced = 0, n_failed = 0;
  int n_not_reproduced() const { return n - n_reproduced - n_failed; }
};
EntryCounts count_entries(const std::vector<TableEntry>& entries);

/// Everything behind the tables: each figure against each reference, what is known of those that are not met,
/// and the command that repeats it; then designs, volumes, advice and the counts. Its lines are as long as
/// they come. No times, dates or machine's name: the same commit writes the same bytes.
void write_audit_text(std::ostream& out, const ThesisResults& results);

/// The document of `tables --json`.
Json results_to_json(const ThesisResults& results);

/// tables.txt, audit.txt, tables.json, and those that have content of: tables.csv, a row per entry and
/// reference; designs.csv, a row per table and design; volumes.csv, a row per case, model and cell;
/// box_plot.csv, a row per case and model (the outliers joined by blanks); advice.csv, a row per Poisson's
/// ratio and design; a .vtu per case.
/// @throws InputError if the folder cannot be written
void write_thesis_files(const std::string& folder, const ThesisResults& results);

} // namespace springproof::compare
