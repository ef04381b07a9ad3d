#include "compare/solve/springs.hpp"

#include "compare/solve/solve.hpp"
#include "fem_reference/element_stiffness.hpp"
#include "msm/model.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <random>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

/// @param exponents  of another cell of the same material, which are this one's too: no second fit
msm::DesignResult design_cell(const cases::Scene& scene, std::size_t cell,
                              const std::optional<msm::Exponents>& exponents = {}) {
  const cases::Material material =
      cases::materials_of(scene.definition)[static_cast<std::size_t>(cases::material_of(scene, cell))];
  cases::Msm options = scene.definition.msm;
  if (exponents) options.exponent = {exponents->edge, exponents->face_diagonal, exponents->internal_diagonal};
  return msm::design(design_request(material, cases::cell_vertices(scene.mesh, cell), options));
}

/// Cells of equal shape and material share one design. Every warning comes once, with the number of its
/// cells.
msm::DesignResult design_cell_by_cell(const cases::Scene& scene) {
  msm::DesignResult all;
  std::map<std::string, int> n_cells;
  std::map<int, msm::DesignResult> of_material;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
    const int material = cases::material_of(scene, c);
    // Unless the mesh is a grid, every cell has its own shape.
    if (of_material.count(material) == 0 || !scene.mesh.grid)
      of_material[material] = design_cell(scene, c, of_material[material].stiffness.exponents);
    const msm::DesignResult& cell = of_material[material];
    for (const std::string& warning : cell.warnings) ++n_cells[warning];
    all.cells.push_back(cell.stiffness);
    if (c == 0) all.moduli = cell.moduli;
  }
  all.stiffness = all.cells.front();
  for (const auto& [warning, n] : n_cells)
    all.warnings.push_back(fmt::format("{} of {} cells: {}", n, all.cells.size(), warning));
  return all;
}

/// The springs of every cell, stiffer beyond the plane.
std::vector<msm::CellStiffness> stiffened(std::vector<msm::CellStiffness> springs,
                                          const cases::Stiffer& stiffer, const cases::HexMesh& mesh) {
  if (springs.size() == 1) springs.resize(mesh.cells.size(), springs.front());
  for (std::size_t c = 0; c < springs.size(); ++c) {
    if (!(cases::centre_of(mesh, mesh.cells[c])[static_cast<int>(stiffer.axis)] > stiffer.beyond)) continue;
    msm::CellStiffness& k = springs[c];
    for (double* of : {&k.edge, &k.face_diagonal, &k.internal_diagonal, &k.volume}) *of *= stiffer.factor;
  }
  return springs;
}

/// Displacements to start from, mm; empty: rest.
msm::Points start_points(const cases::Stress& stress, const cases::HexMesh& mesh) {
  msm::Points start;
  if (stress.start == cases::Start::perturbed) {
    std::mt19937 generator(static_cast<unsigned>(stress.seed));
    // Not std::uniform_real_distribution, whose numbers a standard library may choose.
    const auto any = [&] { return stress.amplitude * (2 * (double(generator()) / 4294967295.0) - 1); };
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const double x = any(), y = any(), z = any();
      start.emplace_back(x, y, z);
    }
  }
  if (stress.start == cases::Start::inverted) {
    double lowest = mesh.nodes.front().z();
    for (const Vector3d& node : mesh.nodes) lowest = std::min(lowest, node.z());
    for (const Vector3d& node : mesh.nodes) start.emplace_back(0, 0, 2 * (lowest - node.z()));
  }
  return start;
}

} // namespace

msm::DesignRequest design_request(const cases::Material& material, const msm::CellVertices& cell,
                                  const cases::Msm& options, cases::Element element) {
  return {material, cell, options,
          [cell, element](const cases::LinearElastic& elastic) {
            return fem_reference::element_stiffness(cell, elastic, element);
          },
          std::nullopt};
}

msm::DesignResult design_for(const cases::Scene& scene) {
  const bool are_alike = scene.mesh.grid && scene.material_of_cell.empty();
  if (are_alike || scene.definition.msm.design == cases::Design::given) return design_cell(scene, 0);
  return design_cell_by_cell(scene);
}

std::vector<msm::CellStiffness> stiffness_of_cells(const msm::DesignResult& design) {
  return design.cells.empty() ? std::vector<msm::CellStiffness>{design.stiffness} : design.cells;
}

mechanics::EquilibriumSettings limited(const cases::Case& definition,
                                       mechanics::EquilibriumSettings settings) {
  if (!definition.stress) return settings;
  const cases::Stress& stress = *definition.stress;
  settings.first_load_step = settings.largest_load_step = 1.0 / stress.least_load_steps;
  settings.max_newton_iterations = stress.max_iterations;
  settings.lowest_eigenvalue = mechanics::LowestEigenvalue::report;
  settings.should_stop = [stopwatch = Stopwatch(), most = stress.max_seconds] {
    return stopwatch.seconds() > most;
  };
  return settings;
}

Answer solve_springs(const cases::Scene& scene, int n_threads, std::optional<msm::DesignResult>& design) {
  const auto& stress = scene.definition.stress;
  const mechanics::EquilibriumSettings settings = limited(scene.definition);
  return solve_side(
      [&] {
        design = design_for(scene);
        std::vector<msm::CellStiffness> springs = stiffness_of_cells(*design);
        if (stress && stress->stiffer) springs = stiffened(std::move(springs), *stress->stiffer, scene.mesh);
        return msm::Model(scene, springs, {msm::Path::automatic, n_threads});
      },
      [&](msm::Model& model) {
        return model.solve(settings, stress ? start_points(*stress, scene.mesh) : msm::Points{});
      });
}

} // namespace springproof::compare
