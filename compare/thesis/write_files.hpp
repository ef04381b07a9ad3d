#pragma once

#include "compare/thesis/regenerate.hpp"

#include <nlohmann/json_fwd.hpp>

/// Results as files. None has a time, a date or a machine's name: the same commit writes the same bytes.
namespace springproof::compare {

/// The document of `tables --json`.
nlohmann::ordered_json results_to_json(const ThesisResults& results);

/// tables.txt, audit.txt, tables.json, and those that have content of: tables.csv, a row per entry and
/// reference; designs.csv, a row per table and design; volumes.csv, a row per case, model and cell;
/// box_plot.csv, a row per case and model (the outliers joined by blanks); advice.csv, a row per Poisson's
/// ratio and design; a .vtu per case.
/// @throws InputError if the folder cannot be written
void write_thesis_files(const std::string& folder, const ThesisResults& results);

} // namespace springproof::compare
