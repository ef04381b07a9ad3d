#pragma once

#include "compare/thesis/results.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>

/// ThesisResults on paper. None of these writes a time, a date or a machine's name: the same commit writes
/// the same bytes.
namespace springproof::compare {

enum class Commands { one_per_table, all };

/// The tables as in print, a row per measure and a column per variant; then designs, volumes, advice and the
/// summary.
void write_tables_text(std::ostream& out, const ThesisResults& results, Commands commands);

/// The parts of it behind the tables.
void write_designs_text(std::ostream& out, const std::vector<DesignRow>& rows);
void write_volumes_text(std::ostream& out, const std::vector<CaseVolumes>& volumes,
                        const std::vector<CellVolumeChange>& changes);
void write_advice_text(std::ostream& out, const std::vector<Advice>& advice);
void write_summary_text(std::ostream& out, const std::vector<SummaryGroup>& groups);

/// One row per entry and reference.
void write_tables_csv(std::ostream& out, const std::vector<TableEntry>& entries);
/// One row per table and design.
void write_designs_csv(std::ostream& out, const std::vector<DesignRow>& rows);
/// One row per case, model and cell.
void write_volumes_csv(std::ostream& out, const std::vector<Comparison>& cases);
/// One row per case and model: quartiles, whiskers, the number of outliers and the outliers, joined by
/// blanks.
void write_box_plot_csv(std::ostream& out, const std::vector<CaseVolumes>& volumes);
/// One row per Poisson's ratio and design.
void write_advice_csv(std::ostream& out, const std::vector<Advice>& advice);

/// The document of `tables --json`.
nlohmann::ordered_json results_to_json(const ThesisResults& results);

/// tables.txt, tables.csv, tables.json, designs.csv, volumes.csv, box_plot.csv, advice.csv (those that have
/// content) and a .vtu per case.
/// @throws InputError if the folder cannot be written
void write_thesis_files(const std::string& folder, const ThesisResults& results);

} // namespace springproof::compare
