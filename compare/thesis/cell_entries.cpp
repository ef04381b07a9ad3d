// Tables 4.1 to 4.3: one cell of edge 2 mm with E = 1 MPa.

#include "compare/solve/design.hpp"
#include "compare/thesis/build_results.hpp"
#include "fem_reference/element_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

constexpr double cell_edge = 2;      // mm; thesis section 4.2.2
constexpr double youngs_modulus = 1; // MPa: with this edge k' = 2 k/(L0 E) is k itself

CellAnalysis analyse_cell(double poissons_ratio) {
  const cases::LinearElastic material{youngs_modulus, poissons_ratio};
  const msm::CellVertices cell = msm::cube(cell_edge);
  const msm::CellStiffness stiffness = msm::design(design_request(material, cell, cases::Msm{})).stiffness;
  return {
      poissons_ratio, stiffness,
      analyse_eigenspaces(full_spectrum(fem_reference::element_stiffness(cell, material, cases::Element::q1)),
                          full_spectrum(msm::cell_stiffness_matrix(cell, stiffness)))};
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
  if (measure == "h") return cell.spaces.h;
  return spectrum_figure(measure, cell.spaces);
}

Trace cell_trace(const PublishedFigure& figure) {
  const std::string nu = fmt::format("{}", figure.poissons_ratio);
  // With E = 0.001 MPa and L0 = 2 mm the stiffnesses in N/m are the pseudo-stiffnesses.
  if (figure.table == "4.1")
    return {"",
            {},
            shell_command({"build/springproof", "design", "--young", "0.001", "--edge", "2", "--poisson", nu,
                           "--method", "linear_method"})};
  return {"", {}, shell_command({"build/springproof", "eigen", "--poisson", nu})};
}

/// Stiffnesses as table 4.1 prints them, to three digits.
std::optional<msm::CellStiffness> printed_stiffness(double poissons_ratio) {
  static const std::vector<PublishedFigure> all = read_published_figures();
  msm::CellStiffness k;
  int n_found = 0;
  for (const PublishedFigure& figure : all) {
    if (figure.table != "4.1" || figure.poissons_ratio != poissons_ratio) continue;
    (figure.measure == "edge"            ? k.edge
     : figure.measure == "face_diagonal" ? k.face_diagonal
                                         : k.internal_diagonal) = figure.value;
    ++n_found;
  }
  return n_found == 3 ? std::optional(k) : std::nullopt;
}

/// What lies between print and us beyond the rounding of the last printed digit.
std::string explain_cell(const PublishedFigure& figure, double computed) {
  const double half_digit = figure.table == "4.1" ? 0.0005 : 0.005;
  const double off = std::abs(computed - figure.value);
  if (off <= half_digit) return "";
  if (figure.measure.rfind("msm_eigenvalue", 0) == 0)
    if (const auto k = printed_stiffness(figure.poissons_ratio)) {
      const Spectrum springs = full_spectrum(msm::cell_stiffness_matrix(msm::cube(cell_edge), *k));
      const auto value = spectrum_figure(figure.measure, analyse_eigenspaces(springs, springs));
      if (value && std::abs(*value - figure.value) <= half_digit)
        return fmt::format("met with the stiffnesses of table 4.1 as printed: {:.4f}", *value);
    }
  return off <= 2 * half_digit ? "one unit of the last printed digit" : "";
}

} // namespace

std::vector<CellAnalysis> analyse_cells(const std::vector<PublishedFigure>& figures) {
  std::vector<double> ratios;
  for (const PublishedFigure& figure : figures)
    if (figure.test == "cell") ratios.push_back(figure.poissons_ratio);
  std::sort(ratios.begin(), ratios.end());
  ratios.erase(std::unique(ratios.begin(), ratios.end()), ratios.end());
  std::vector<CellAnalysis> cells;
  for (const double nu : ratios) cells.push_back(analyse_cell(nu));
  return cells;
}

std::vector<TableEntry> cell_entries(const std::vector<PublishedFigure>& figures,
                                     const std::vector<CellAnalysis>& cells) {
  std::vector<TableEntry> entries;
  for (const PublishedFigure& figure : figures) {
    if (figure.test != "cell") continue;
    const auto cell = std::find_if(cells.begin(), cells.end(), [&](const CellAnalysis& c) {
      return c.poissons_ratio == figure.poissons_ratio;
    });
    ComputedFigure computed;
    computed.reference = "one q1 cell";
    if (cell != cells.end()) computed.value = figure_of(*cell, figure.measure);
    if (!computed.value) computed.reason = "the cell has no " + figure.measure;
    computed.trace = cell_trace(figure);
    entries.push_back({figure, {computed}, computed.value ? explain_cell(figure, *computed.value) : ""});
  }
  return entries;
}

} // namespace springproof::compare
