#pragma once

#include "compare/table/json.hpp"
#include "compare/thesis/regenerate.hpp"

#include <array>
#include <ostream>
#include <string>
#include <vector>

/// Results as grids of entries, as text and files. Unless a text says where they are, none has a time, a date
/// or a machine's name: the same commit writes the same bytes.
namespace springproof::compare {

/// One table as a grid of its entries, in the order of print: a row per measure, a column per variant.
struct Sheet {
  struct Row {
    std::string test, measure;
    std::vector<const TableEntry*> cells; ///< one per column; null where print has no figure
    const TableEntry* first;              ///< first cell that is not null
  };
  std::string table;
  std::vector<std::array<std::string, 3>> columns{}; ///< design, "nu = 0.35", load set
  std::vector<Row> rows{};
  std::vector<const TableEntry*> entries{};
};

/// The tables of these entries, which stand table by table.
std::vector<Sheet> sheets_of(const std::vector<TableEntry>& entries);

/// "Table 4.5", "Figure 5.12".
std::string name_of(const Sheet& sheet);

/// "shear alpha_1, linear_method, nu = 0.35, small": one figure, told from the others of its table.
std::string name_of(const PublishedFigure& figure);

/// What the table's figures are, with their unit.
std::string subject_of(const Sheet& sheet);

/// A value as the tables write it; "-" without one, and never "-0.00".
std::string value_text(const std::optional<double>& value, int digits = 2);

/// Decimals that a figure is written with.
int digits_of(const PublishedFigure& figure);

/// Our value and its difference from print: "  34.21   +0.05". The value is against the reference that the
/// case file declares; "*" says that print is nearer to another reference of the thesis. "failed" without a
/// value of the declared one; "!" when another reference's solve failed.
std::string cell_text(const TableEntry& entry);

/// All tables' lines, an empty one between them; two neighbours that are narrow stand side by side.
std::vector<std::string> lines_of(const std::vector<Sheet>& sheets);

/// The table with a row for each reference, then print, their difference and what is known of both, and the
/// command of each figure.
void write_sheet(std::ostream& out, const Sheet& sheet);

/// The tables as in print: measures down, Poisson's ratios across, each value with its difference from print
/// beside it. Then the counts and the design to use, on a few screens of screen_width characters. No times,
/// dates or machine's name: the same commit writes the same bytes.
void write_tables_text(std::ostream& out, const ThesisResults& results);

/// Tells where the audit of each figure is.
/// @param folder  value of `--out`; empty: none was given, and what to type is told
void write_where_text(std::ostream& out, const ThesisResults& results, const std::string& folder);

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
