#include "compare/thesis/sheet.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// The parts that tell an entry's column from others.
std::array<std::string, 3> column_of(const PublishedFigure& p) {
  return {p.design, fmt::format("nu = {:g}", p.poissons_ratio), p.load_set};
}

std::pair<std::string, std::string> row_of(const PublishedFigure& p) {
  return {p.test, p.measure};
}

template<class Value>
void add_unique(std::vector<Value>& values, const Value& value) {
  if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
}

} // namespace

const TableEntry* Sheet::find(std::size_t row, std::size_t column) const {
  for (const TableEntry* entry : entries)
    if (rows[row] == row_of(entry->published) && columns[column] == column_of(entry->published)) return entry;
  return nullptr;
}

const TableEntry* Sheet::first_of_row(std::size_t row) const {
  for (const TableEntry* entry : entries)
    if (rows[row] == row_of(entry->published)) return entry;
  return nullptr;
}

std::vector<Sheet> sheets_of(const std::vector<TableEntry>& entries) {
  std::vector<Sheet> sheets;
  for (const TableEntry& entry : entries) {
    const std::string& table = entry.published.table;
    auto sheet = std::find_if(sheets.begin(), sheets.end(), [&](const Sheet& s) { return s.table == table; });
    if (sheet == sheets.end()) sheet = sheets.insert(sheets.end(), Sheet{table, {}, {}, {}});
    sheet->entries.push_back(&entry);
    add_unique(sheet->rows, row_of(entry.published));
    add_unique(sheet->columns, column_of(entry.published));
  }
  return sheets;
}

std::string name_of(const Sheet& sheet) {
  return (sheet.table == "5.12" ? "Figure " : "Table ") + sheet.table;
}

std::string name_of(const PublishedFigure& figure) {
  std::string name = figure.test + " " + figure.measure;
  for (const std::string& part : column_of(figure)) name += part.empty() ? "" : ", " + part;
  return name;
}

std::string subject_of(const Sheet& sheet) {
  if (sheet.table == "4.1") return "pseudo-stiffnesses k' of the springs, k = (L0/2) k' E";
  if (sheet.table == "4.2") return "eigenvalues (N/mm for E = 1 MPa, L0 = 2 mm) and multiplicities";
  if (sheet.table == "4.3") return "similarity h of the two matrices' eigenspaces";
  if (sheet.entries.front()->published.unit == "mm3") return "volume of the springs' body, mm3";
  return "error r = (MSM - FEM)/FEM x 100 %";
}

} // namespace springproof::compare
