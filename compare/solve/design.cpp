#include "compare/solve/design.hpp"

#include "fem_reference/element_stiffness.hpp"

#include <fmt/format.h>
#include <map>

namespace springproof::compare {

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

msm::DesignResult design_cell(const cases::Scene& scene, std::size_t cell) {
  const cases::Material material =
      cases::materials_of(scene.definition)[static_cast<std::size_t>(cases::material_of(scene, cell))];
  return msm::design(design_request(material, cases::cell_vertices(scene.mesh, cell), scene.definition.msm));
}

/// Cells of equal shape and material share one design.
msm::DesignResult design_cell_by_cell(const cases::Scene& scene) {
  msm::DesignResult all;
  std::map<std::string, int> n_cells;
  std::map<int, msm::DesignResult> of_material; // on a grid
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
    msm::DesignResult cell;
    if (scene.mesh.grid) {
      const int material = cases::material_of(scene, c);
      if (of_material.count(material) == 0) of_material[material] = design_cell(scene, c);
      cell = of_material[material];
    } else {
      cell = design_cell(scene, c);
    }
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
  const bool are_alike = scene.mesh.grid && scene.material_of_cell.empty();
  if (are_alike || scene.definition.msm.design == cases::Design::given) return design_cell(scene, 0);
  return design_cell_by_cell(scene);
}

std::vector<msm::CellStiffness> stiffness_of_cells(const msm::DesignResult& design) {
  if (design.cells.empty()) return {design.stiffness};
  return design.cells;
}

} // namespace springproof::compare
