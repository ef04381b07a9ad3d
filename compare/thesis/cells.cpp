#include "compare/thesis/cells.hpp"

#include "compare/solve/springs.hpp"

#include <cmath>
#include <fmt/format.h>
#include <set>

namespace springproof::compare {

namespace {

constexpr double cell_edge = 2;    // mm; thesis section 4.2.2
constexpr double cell_modulus = 1; // MPa: with this edge k' = 2 k/(L0 E) is k itself

Spectrum springs_spectrum(const msm::CellStiffness& stiffness) {
  return full_spectrum(msm::cell_stiffness_matrix(msm::cube(cell_edge), stiffness));
}

CellAnalysis analyse_cell(double poissons_ratio) {
  const cases::LinearElastic material{cell_modulus, poissons_ratio};
  cases::Msm options;
  options.design = cases::Design::linear_method;
  const msm::DesignRequest request = design_request(material, msm::cube(cell_edge), options);
  const msm::CellStiffness stiffness = msm::design(request).stiffness;
  return {
      poissons_ratio, stiffness,
      analyse_eigenspaces(full_spectrum(request.element_stiffness(material)), springs_spectrum(stiffness))};
}

/// "fem_eigenvalue_2" -> model "fem", what "eigenvalue", index 1.
std::optional<double> spectrum_figure(const std::string& measure, const EigenspaceAnalysis& spaces) {
  const std::size_t first = measure.find('_'), last = measure.rfind('_');
  const std::string what = measure.substr(first + 1, last - first - 1);
  const auto& of_model = measure.substr(0, first) == "fem" ? spaces.fem_spaces : spaces.msm_spaces;
  const std::size_t index = std::stoul(measure.substr(last + 1)) - 1;
  if (index >= of_model.size()) return std::nullopt;
  return what == "eigenvalue" ? of_model[index].eigenvalue : of_model[index].dimension;
}

std::optional<double> figure_of(const CellAnalysis& cell, const std::string& measure) {
  if (measure == "edge") return cell.stiffness.edge;
  if (measure == "face_diagonal") return cell.stiffness.face_diagonal;
  if (measure == "internal_diagonal") return cell.stiffness.internal_diagonal;
  return measure == "h" ? cell.spaces.h : spectrum_figure(measure, cell.spaces);
}

Trace cell_trace(const PublishedFigure& figure) {
  const std::string nu = fmt::format("{}", figure.poissons_ratio);
  if (figure.table != "4.1") return {"", {}, shell_command({"eigen", "--poisson", nu})};
  // With E = 0.001 MPa and L0 = 2 mm the stiffnesses in N/m are the pseudo-stiffnesses.
  return {"",
          {},
          shell_command(
              {"design", "--young", "0.001", "--edge", "2", "--poisson", nu, "--method", "linear_method"})};
}

/// Stiffnesses as table 4.1 prints them, to three digits.
std::optional<msm::CellStiffness> printed_stiffness(double poissons_ratio) {
  std::vector<double> k;
  for (const PublishedFigure& figure : published_figures())
    if (figure.table == "4.1" && figure.poissons_ratio == poissons_ratio) k.push_back(figure.value);
  return k.size() == 3 ? std::optional(msm::CellStiffness{k[0], k[1], k[2]}) : std::nullopt;
}

/// What lies between print and us beyond the rounding of the last printed digit.
std::string explain_cell(const PublishedFigure& figure, double computed) {
  const double half_digit = figure.table == "4.1" ? 0.0005 : 0.005;
  const double off = std::abs(computed - figure.value);
  if (off <= half_digit) return "";
  if (figure.measure.rfind("msm_eigenvalue", 0) == 0)
    if (const auto k = printed_stiffness(figure.poissons_ratio)) {
      const Spectrum springs = springs_spectrum(*k);
      const auto value = spectrum_figure(figure.measure, analyse_eigenspaces(springs, springs));
      if (value && std::abs(*value - figure.value) <= half_digit)
        return fmt::format("met with the stiffnesses of table 4.1 as printed: {:.4f}", *value);
    }
  return off <= 2 * half_digit ? "one unit of the last printed digit" : "";
}

} // namespace

std::vector<CellAnalysis> analyse_cells(const std::vector<PublishedFigure>& figures) {
  std::set<double> ratios;
  for (const PublishedFigure& figure : figures)
    if (figure.test == "cell") ratios.insert(figure.poissons_ratio);
  std::vector<CellAnalysis> cells;
  for (const double nu : ratios) cells.push_back(analyse_cell(nu));
  return cells;
}

std::vector<TableEntry> cell_entries(const std::vector<PublishedFigure>& figures,
                                     const std::vector<CellAnalysis>& cells) {
  std::vector<TableEntry> entries;
  for (const PublishedFigure& figure : figures) {
    if (figure.test != "cell") continue;
    ComputedFigure computed{"one q1 cell"};
    for (const CellAnalysis& cell : cells)
      if (cell.poissons_ratio == figure.poissons_ratio) computed.value = figure_of(cell, figure.measure);
    if (!computed.value) computed.reason = "the cell has no " + figure.measure;
    computed.trace = cell_trace(figure);
    entries.push_back({figure, {computed}, computed.value ? explain_cell(figure, *computed.value) : ""});
  }
  return entries;
}

} // namespace springproof::compare
