#pragma once

#include "compare/thesis/regenerate.hpp"

#include <array>
#include <ostream>

namespace springproof::compare {

/// One table as a grid of its entries, in the order of print: a row per measure, a column per variant.
struct Sheet {
  struct Row {
    std::string test, measure;
    std::vector<const TableEntry*> cells; ///< one per column; null where print has no figure
    const TableEntry* first;              ///< of the cells that are not null
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

enum class Commands { one_per_table, all };

/// The tables as in print, a row per measure and a column per variant; then designs, volumes, advice and the
/// summary. No times, dates or machine's name: the same commit writes the same bytes.
void write_tables_text(std::ostream& out, const ThesisResults& results, Commands commands);

} // namespace springproof::compare
