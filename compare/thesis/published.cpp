#include "compare/thesis/published.hpp"

#include "cases/case/error.hpp"
#include "compare/provenance/cases_folder.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

namespace springproof::compare {

namespace {

double number(const std::string& text, const std::string& path) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw cases::InputError(path + ": '" + text + "' is not a number");
  return value;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line.substr(0, line.find('\r'))); // a file from Windows is read too
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

PublishedFigure of_cell(const std::string& table, double poissons_ratio, const std::string& measure,
                        const std::string& unit, double value) {
  return {table, "linear_elastic", poissons_ratio, "linear_method", poissons_ratio, "", "cell", measure, unit,
          value};
}

void read_cell_figures(const std::string& folder, std::vector<PublishedFigure>& figures) {
  const std::string springs = folder + "pseudo_stiffness.csv", values = folder + "eigenvalues.csv",
                    metric = folder + "h_metric.csv";
  const char* kinds[] = {"edge", "face_diagonal", "internal_diagonal"};
  for (std::size_t kind = 0; kind < 3; ++kind) // row by row, as in print
    for (const auto& row : read_csv(springs))
      figures.push_back(of_cell(row.at(0), number(row.at(1), springs), kinds[kind], "1",
                                number(row.at(2 + kind), springs)));
  for (const auto& row : read_csv(values)) {
    const double nu = number(row.at(1), values);
    figures.push_back(
        of_cell(row.at(0), nu, row.at(2) + "_eigenvalue_" + row.at(3), "N/mm", number(row.at(4), values)));
    figures.push_back(
        of_cell(row.at(0), nu, row.at(2) + "_multiplicity_" + row.at(3), "1", number(row.at(5), values)));
  }
  for (const auto& row : read_csv(metric))
    figures.push_back(of_cell(row.at(0), number(row.at(1), metric), "h", "1", number(row.at(2), metric)));
}

} // namespace

std::vector<std::vector<std::string>> read_csv(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw cases::InputError(path + ": cannot be read, or is empty");
  const std::size_t width = split(line).size();
  std::vector<std::vector<std::string>> rows;
  for (int number = 2; std::getline(file, line); ++number) {
    rows.push_back(split(line));
    if (rows.back().size() != width)
      throw cases::InputError(path + ":" + std::to_string(number) + ": " +
                              std::to_string(rows.back().size()) + " fields where the header has " +
                              std::to_string(width));
  }
  return rows;
}

std::vector<PublishedFigure> read_published_figures() {
  const std::string folder = cases_folder() + "/published/";
  const std::string nonlinear = "nonlinear_method";
  std::vector<PublishedFigure> figures;
  const std::string errors = folder + "errors.csv", volumes = folder + "volumes.csv",
                    bar = folder + "bar_deflection.csv";
  read_cell_figures(folder, figures);
  for (const auto& row : read_csv(errors))
    figures.push_back({row.at(0), row.at(1), number(row.at(2), errors), row.at(3), number(row.at(4), errors),
                       row.at(5), row.at(6), row.at(7), "%", number(row.at(8), errors)});
  // Table 5.2 and figure 5.12 are of the Ogden material and its nonlinear design (thesis sections 5.3.1.3
  // and 5.3.3).
  for (const auto& row : read_csv(volumes))
    figures.push_back({row.at(0), "ogden", 0.5, nonlinear, 0.5, row.at(1), row.at(2), "volume", "mm3",
                       number(row.at(3), volumes)});
  for (const auto& row : read_csv(bar))
    figures.push_back({row.at(0), "ogden", 0.5, nonlinear, 0.5, "",
                       "bar_" + row.at(1) + "x" + row.at(2) + "x" + row.at(3), "deflection", "%",
                       number(row.at(4), bar)});
  return figures;
}

double published_cell_volume_change(const std::string& load_set) {
  const std::string path = cases_folder() + "/published/cell_volumes.csv";
  for (const auto& row : read_csv(path))
    if (row.at(1) == load_set) return number(row.at(2), path);
  throw cases::InputError(path + ": has no load set '" + load_set + "'");
}

std::optional<std::array<double, 3>>
published_stiffness(const std::string& design, const std::string& material, double design_poissons_ratio) {
  const std::string path = cases_folder() + "/published/stiffness.csv";
  // The cube's linear elastic material has E = 0.3 MPa; chapter 6 prints sets for others.
  const std::string wanted = material == "linear_elastic" ? "linear_elastic E=0.3 MPa" : material;
  for (const auto& row : read_csv(path))
    if (row.at(1) == design && row.at(2) == wanted && number(row.at(3), path) == design_poissons_ratio &&
        number(row.at(4), path) == 1)
      return std::array<double, 3>{number(row.at(5), path), number(row.at(6), path), number(row.at(7), path)};
  return std::nullopt;
}

} // namespace springproof::compare
