#include "compare/design.hpp"

#include "fem_reference/element_stiffness.hpp"

#include <fmt/format.h>
#include <map>

namespace compare {

msm::DesignRequest design_request(const cases::Material& material, const msm::CellVertices& cell,
                                  const cases::Msm& options, cases::Element element) {
  return {material, cell, options,
          [cell, element](const cases::LinearElastic& elastic) {
            return fem_reference::element_stiffness(cell, elastic, element);
          },
          std::nullopt};
}

namespace {

/// Every warning once, with the number of cells that have it.
std::vector<std::string> counted(const std::map<std::string, int>& n_cells, std::size_t n_all) {
  std::vector<std::string> warnings;
  for (const auto& [warning, n] : n_cells)
    warnings.push_back(fmt::format("{} of {} cells: {}", n, n_all, warning));
  return warnings;
}

msm::DesignResult design_cell_by_cell(const cases::Scene& scene) {
  msm::DesignResult all;
  std::map<std::string, int> n_cells;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
    const msm::DesignResult cell = msm::design(
        design_request(scene.definition.material, cases::cell_vertices(scene.mesh, c), scene.definition.msm));
    for (const std::string& warning : cell.warnings) ++n_cells[warning];
    all.cells.push_back(cell.stiffness);
    if (c == 0) all.moduli = cell.moduli;
  }
  all.stiffness = all.cells.front();
  all.warnings = counted(n_cells, all.cells.size());
  return all;
}

} // namespace

msm::DesignResult design_for(const cases::Scene& scene) {
  const cases::Msm& options = scene.definition.msm;
  if (!scene.mesh.grid && options.design != cases::Design::given) return design_cell_by_cell(scene);
  return msm::design(design_request(scene.definition.material, cases::cell_vertices(scene.mesh, 0), options));
}

std::vector<msm::CellStiffness> stiffness_of_cells(const msm::DesignResult& design) {
  if (design.cells.empty()) return {design.stiffness};
  return design.cells;
}

} // namespace compare
