#pragma once

#include "compare/thesis/entries.hpp"

#include <array>
#include <ostream>

/// The thesis's tables as grids of entries, and in lines of a screen.
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

} // namespace springproof::compare
