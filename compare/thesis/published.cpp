#include "compare/thesis/published.hpp"

#include "cases/case/error.hpp"
#include "cases/case/rows.hpp"
#include "compare/provenance/machine.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

namespace springproof::compare {

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line.substr(0, line.find('\r'))); // a file from Windows is read too
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

std::string path_of(const std::string& name) {
  return cases_folder() + "/published/" + name + ".csv";
}

std::vector<PublishedFigure> read_published_figures() {
  std::vector<PublishedFigure> figures;
  const auto add_of_cell = [&](const CsvRow& row, const std::string& measure, const std::string& unit,
                               std::size_t field) {
    figures.push_back({row[0], "linear_elastic", row.number(1), "linear_method", row.number(1), "", "cell",
                       measure, unit, row.number(field)});
  };
  const char* springs[] = {"edge", "face_diagonal", "internal_diagonal"};
  for (std::size_t kind = 0; kind < 3; ++kind) // row by row, as in print
    for (const CsvRow& row : read_csv(path_of("pseudo_stiffness")))
      add_of_cell(row, springs[kind], "1", 2 + kind);
  for (const CsvRow& row : read_csv(path_of("eigenvalues"))) {
    add_of_cell(row, row[2] + "_eigenvalue_" + row[3], "N/mm", 4);
    add_of_cell(row, row[2] + "_multiplicity_" + row[3], "1", 5);
  }
  for (const CsvRow& row : read_csv(path_of("h_metric"))) add_of_cell(row, "h", "1", 2);
  for (const CsvRow& row : read_csv(path_of("errors")))
    figures.push_back(
        {row[0], row[1], row.number(2), row[3], row.number(4), row[5], row[6], row[7], "%", row.number(8)});
  // Table 5.2 and figure 5.12 are of the Ogden material and its nonlinear design (thesis sections 5.3.1.3
  // and 5.3.3).
  for (const CsvRow& row : read_csv(path_of("volumes")))
    figures.push_back(
        {row[0], "ogden", 0.5, "nonlinear_method", 0.5, row[1], row[2], "volume", "mm3", row.number(3)});
  for (const CsvRow& row : read_csv(path_of("bar_deflection")))
    figures.push_back({row[0], "ogden", 0.5, "nonlinear_method", 0.5, "",
                       "bar_" + row[1] + "x" + row[2] + "x" + row[3], "deflection", "%", row.number(4)});
  const auto number = [](const PublishedFigure& figure) {
    return std::pair(figure.table.size(), figure.table);
  };
  std::stable_sort(figures.begin(), figures.end(),
                   [&](const PublishedFigure& a, const PublishedFigure& b) { return number(a) < number(b); });
  return figures;
}

} // namespace

double CsvRow::number(std::size_t field) const {
  const std::string& text = fields.at(field);
  if (const auto value = cases::number_in<double>(text)) return *value;
  throw cases::InputError(path + ": '" + text + "' is not a number");
}

std::vector<CsvRow> read_csv(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw cases::InputError(path + ": cannot be read, or is empty");
  const std::size_t width = split(line).size();
  std::vector<CsvRow> rows;
  for (int number = 2; std::getline(file, line); ++number) {
    rows.push_back({path, split(line)});
    const std::size_t n_fields = rows.back().fields.size();
    if (n_fields != width)
      throw cases::InputError(path + ":" + std::to_string(number) + ": " + std::to_string(n_fields) +
                              " fields where the header has " + std::to_string(width));
  }
  return rows;
}

const std::vector<PublishedFigure>& published_figures() {
  static const std::vector<PublishedFigure> all = read_published_figures();
  return all;
}

std::vector<std::string> tables_of(const std::vector<PublishedFigure>& figures) {
  std::vector<std::string> tables;
  for (const PublishedFigure& figure : figures)
    if (std::find(tables.begin(), tables.end(), figure.table) == tables.end()) tables.push_back(figure.table);
  return tables;
}

double published_cell_volume_change(const std::string& load_set) {
  const std::string path = path_of("cell_volumes");
  for (const CsvRow& row : read_csv(path))
    if (row[1] == load_set) return row.number(2);
  throw cases::InputError(path + ": has no load set '" + load_set + "'");
}

std::optional<std::array<double, 3>>
published_stiffness(const std::string& design, const std::string& material, double design_poissons_ratio) {
  // The cube's linear elastic material has E = 0.3 MPa; chapter 6 prints sets for others.
  const std::string wanted = material == "linear_elastic" ? "linear_elastic E=0.3 MPa" : material;
  for (const CsvRow& row : read_csv(path_of("stiffness")))
    if (row[1] == design && row[2] == wanted && row.number(3) == design_poissons_ratio && row.number(4) == 1)
      return std::array<double, 3>{row.number(5), row.number(6), row.number(7)};
  return std::nullopt;
}

} // namespace springproof::compare
