#include "compare/thesis/sheets.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// The parts that tell an entry's column from others.
std::array<std::string, 3> column_of(const PublishedFigure& p) {
  return {p.design, fmt::format("nu = {:g}", p.poissons_ratio), p.load_set};
}

} // namespace

std::vector<Sheet> sheets_of(const std::vector<TableEntry>& entries) {
  std::vector<Sheet> sheets;
  for (const TableEntry& entry : entries) {
    if (sheets.empty() || sheets.back().table != entry.published.table)
      sheets.push_back({entry.published.table});
    auto& columns = sheets.back().columns;
    sheets.back().entries.push_back(&entry);
    if (std::find(columns.begin(), columns.end(), column_of(entry.published)) == columns.end())
      columns.push_back(column_of(entry.published));
  }
  for (auto& [table, columns, rows, of_table] : sheets)
    for (const TableEntry* entry : of_table) {
      const PublishedFigure& p = entry->published;
      auto row = std::find_if(rows.begin(), rows.end(), [&](const Sheet::Row& r) {
        return r.test == p.test && r.measure == p.measure;
      });
      if (row == rows.end())
        row = rows.insert(row, {p.test, p.measure, std::vector<const TableEntry*>(columns.size()), entry});
      row->cells[std::find(columns.begin(), columns.end(), column_of(p)) - columns.begin()] = entry;
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

std::string value_text(const std::optional<double>& value, int digits) {
  if (!value) return "-";
  const std::string text = fmt::format("{:.{}f}", *value, digits);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero ? fmt::format("{:.{}f}", 0.0, digits) : text; // never "-0.00"
}

int digits_of(const PublishedFigure& figure) {
  if (figure.measure.find("multiplicity") != std::string::npos) return 0;
  return figure.test == "cell" ? 4 : 2;
}

} // namespace springproof::compare
