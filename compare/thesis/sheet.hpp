#pragma once

#include "compare/thesis/results.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace springproof::compare {

/// One table as a grid of its entries, in the order of print: a row per measure, a column per variant.
struct Sheet {
  std::string table;
  std::vector<std::pair<std::string, std::string>> rows; ///< test, measure
  std::vector<std::array<std::string, 3>> columns;       ///< design, "nu = 0.35", load set
  std::vector<const TableEntry*> entries;
  const TableEntry* find(std::size_t row, std::size_t column) const; ///< null where print has no figure
  const TableEntry* first_of_row(std::size_t row) const;
};

/// The tables of these entries, in their order.
std::vector<Sheet> sheets_of(const std::vector<TableEntry>& entries);

/// "Table 4.5", "Figure 5.12".
std::string name_of(const Sheet& sheet);

/// "shear alpha_1, linear_method, nu = 0.35, small": one figure, told from the others of its table.
std::string name_of(const PublishedFigure& figure);

/// What the table's figures are, with their unit.
std::string subject_of(const Sheet& sheet);

} // namespace springproof::compare
