#include "compare/solve/springs.hpp"

#include "cases/scene/network.hpp"
#include "cases/scene/regions.hpp"
#include "cases/scene/thickness.hpp"
#include "compare/solve/design_by_shape.hpp"
#include "compare/solve/from_equilibrium.hpp"
#include "compare/solve/solve.hpp"
#include "fem_reference/element_stiffness.hpp"
#include "msm/model.hpp"
#include "msm/moving_springs.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <random>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

/// The designs of a scene's cells. Cells of a material share one; on a mesh that is no grid every cell has
/// its own shape, and a design of four stiffnesses for itself.
struct DesignedCells {
  std::vector<msm::DesignResult> designs;
  std::vector<std::size_t> of_cell; ///< index of designs
};

DesignedCells design_cells(const cases::Scene& scene) {
  const bool is_given = cases::facts_of(scene.definition.msm.design).source == cases::DesignSource::file;
  const bool follows_shape = !scene.mesh.grid && !is_assembled(scene) && !is_given;
  const std::vector<cases::Material> materials = cases::materials_of(scene.definition);
  const cases::Msm& given = scene.definition.msm;
  const std::vector<int> across =
      given.design == cases::Design::midline && !given.beta
          ? cases::cells_across(scene.mesh, scene.definition.symmetry, msm::DesignRequest::many_cells)
          : std::vector<int>();
  DesignedCells all;
  std::map<int, std::size_t> of_material;
  std::map<std::pair<int, int>, std::size_t> of_cell; // by material and thickness
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
    const int material = is_given ? 0 : cases::material_of(scene, c), n = across.empty() ? 0 : across[c];
    const auto [known, is_new] = of_cell.try_emplace({material, n}, all.designs.size());
    if (is_new || follows_shape) {
      const auto [first, is_first] = of_material.try_emplace(material, all.designs.size());
      msm::DesignRequest request = design_request(materials[cases::index(cases::material_of(scene, c))],
                                                  cases::cell_vertices(scene.mesh, c), given);
      if (n > 0) request.cells_across = n;
      if (!is_first) // the exponents of the material's other cells: no second fit
        msm::set_law(request.options, all.designs[first->second].stiffness.exponents);
      known->second = all.designs.size();
      all.designs.push_back(msm::design(request));
    }
    all.of_cell.push_back(known->second);
  }
  return all;
}

/// The parity i + j + k of every cell (i, j, k) of a grid.
std::vector<int> parities(const cases::Grid& grid) {
  std::vector<int> all;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i)
        if (grid.has(i, j, k)) all.push_back((i + j + k) % 2);
  return all;
}

/// The designs as terms, whose mirror images take turns in the grid.
/// @throws InputError on a mesh that is no grid when the design has mirror images or stiffnesses by axis
msm::BodyTerms terms_of_cells(const cases::Scene& scene, const DesignedCells& cells) {
  msm::BodyTerms all;
  for (const msm::DesignResult& design : cells.designs) {
    const msm::BodyTerms own =
        design.springs.terms() ? *design.springs.terms() : msm::BodyTerms{{msm::terms_of(design.stiffness)}};
    all.kinds.insert(all.kinds.end(), own.kinds.begin(), own.kinds.end());
    all.boundary = own.boundary;
  }
  const std::size_t n_images = all.kinds.size() / cells.designs.size();
  const cases::Design design = scene.definition.msm.design;
  const bool is_by_axis = design == cases::Design::given || design == cases::Design::transverse;
  if ((n_images > 1 || is_by_axis) && !scene.mesh.grid)
    throw cases::InputError(
        scene.definition.msm.where,
        fmt::format("design = \"{}\" is for bodies that are grids of equal cells", cases::name_of(design)));
  const std::vector<int> parity = n_images > 1 ? parities(*scene.mesh.grid) : std::vector<int>();
  for (std::size_t c = 0; c < cells.of_cell.size(); ++c)
    all.kind_of_cell.push_back(static_cast<int>(n_images * cells.of_cell[c]) +
                               (n_images > 1 ? parity[c] : 0));
  all.planes_of_node = cases::planes_of_nodes(scene.mesh, scene.definition.symmetry);
  return all;
}

/// Tells of several designs every warning once, with the number of its cells, and the worst misfit.
void count_warnings(const DesignedCells& cells, msm::DesignResult& all) {
  const std::size_t n = cells.of_cell.size();
  std::map<std::string, int> n_cells;
  int n_misfits = 0;
  for (const std::size_t of_cell : cells.of_cell) {
    const msm::DesignResult& cell = cells.designs[of_cell];
    for (const std::string& warning : cell.warnings)
      ++(cell.misfit && warning == cell.misfit->text ? n_misfits : n_cells[warning]);
    if (cell.misfit && !(all.misfit && cell.misfit->largest <= all.misfit->largest)) all.misfit = cell.misfit;
  }
  all.warnings.clear();
  for (const auto& [warning, of_warning] : n_cells)
    all.warnings.push_back(fmt::format("{} of {} cells: {}", of_warning, n, warning));
  if (n_misfits > 0)
    all.warnings.push_back(fmt::format("{} of {} cells, the worst: {}", n_misfits, n, all.misfit->text));
}

/// Displacements to start from, mm; empty: rest.
msm::Points start_points(const cases::Stress& stress, const cases::Mesh& mesh) {
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

cases::Scene with_design(cases::Scene scene, cases::Design design) {
  cases::Msm& own = scene.definition.msm;
  if (own.design == design) return scene;
  cases::Msm other;
  other.design = design;
  other.accepted = own.accepted;
  other.real_time = own.real_time;
  other.mass = own.mass;
  other.where = own.where;
  cases::settle_law(other, cases::materials_of(scene.definition),
                    cases::has_nodal_forces(scene.definition.loads));
  own = other;
  return scene;
}

bool is_assembled(const cases::Scene& scene) {
  using D = cases::Design;
  const cases::Msm& options = scene.definition.msm;
  const auto& grid = scene.mesh.grid;
  const bool has_cubes =
      !grid || ((grid->spacing.array() - grid->spacing[0]).abs() <= 1e-9 * grid->spacing[0]).all();
  const bool follows_cells = options.design == D::moduli || options.design == D::hybrid ||
                             options.design == D::matched || options.design == D::midline;
  const auto materials = cases::materials_of(scene.definition);
  const bool has_fibre =
      options.design == D::midline && !std::all_of(materials.begin(), materials.end(), cases::is_isotropic);
  const bool is_by_axis =
      (options.design == D::given && options.axis_stiffness) || has_fibre || (follows_cells && !has_cubes);
  return is_by_axis || cases::facts_of(options.design).cells != cases::DesignCells::four_stiffnesses;
}

msm::DesignResult design_for(const cases::Scene& scene) {
  if (scene.definition.msm.design == cases::Design::network) {
    msm::DesignResult network;
    network.springs = scene.network;
    network.warnings = cases::doubts_of(scene.network, [&](int n) { return Vector3d(scene.mesh.nodes[n]); });
    for (const std::string& part : cases::loose_parts_of(scene)) network.warnings.push_back(part);
    return network;
  }
  if (is_designed_by_shape(scene)) return design_by_shape(scene);
  const DesignedCells cells = design_cells(scene);
  const std::vector<msm::DesignResult>& designs = cells.designs;
  msm::DesignResult all = designs.front();
  const auto has_terms = [](const msm::DesignResult& design) { return design.springs.terms() != nullptr; };
  if (is_assembled(scene) || std::any_of(designs.begin(), designs.end(), has_terms)) {
    all.springs = terms_of_cells(scene, cells);
  } else if (designs.size() > 1) {
    std::vector<msm::CellStiffness> stiffness;
    for (const std::size_t of_cell : cells.of_cell) stiffness.push_back(designs[of_cell].stiffness);
    all.springs = std::move(stiffness);
  }
  if (designs.size() == 1) return all;
  all.residual.reset();
  count_warnings(cells, all);
  return all;
}

msm::SpringBody springs_as_solved(const cases::Scene& scene, const msm::DesignResult& design) {
  const auto& stress = scene.definition.stress;
  if (!stress || !stress->stiffer) return design.springs;
  if (design.springs.network())
    throw cases::InputError(scene.definition.msm.where, "design = \"network\": its springs have their own "
                                                        "stiffnesses; leave stress.stiffer out");
  return msm::scaled(design.springs, scene.mesh.cells.size(), [&](std::size_t cell) {
    const Vector3d centre = cases::centre_of(scene.mesh, scene.mesh.cells[cell]);
    const bool is_beyond = centre[static_cast<int>(stress->stiffer->axis)] > stress->stiffer->beyond;
    return is_beyond ? stress->stiffer->factor : 1;
  });
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

cases::Solution with_fields(const cases::Scene& scene, const msm::SpringBody& springs,
                            cases::Solution solution) {
  if (scene.definition.has_fields) solution.fields = msm::fields(scene, springs, solution);
  return solution;
}

Answer solve_springs(const cases::Scene& scene, int n_threads, std::optional<msm::DesignResult>& design) {
  return solve_springs(scene, n_threads, design, {});
}

Answer solve_springs(const cases::Scene& scene, int n_threads, std::optional<msm::DesignResult>& design,
                     const mechanics::StepLimits& limits) {
  if (scene.definition.dynamics)
    return solve_side(
        [&] { return *(design = design_for(scene)); },
        [&](const msm::DesignResult& designed) {
          const cases::Msm& given = scene.definition.msm;
          mechanics::IntegrationSettings settings;
          if (given.real_time) {
            settings = msm::in_substeps(scene, designed.springs, scene.definition.dynamics->step);
            settings.newton.should_stop = limits.should_stop;
          } else if (given.iterations_per_step) {
            settings = mechanics::in_real_time(*given.iterations_per_step);
          }
          return msm::follow(scene, designed.springs, {msm::Path::automatic, n_threads, {}, {}}, settings);
        });
  const auto& stress = scene.definition.stress;
  const mechanics::EquilibriumSettings settings = limited(scene.definition);
  msm::SpringBody springs;
  const auto take_springs = [&] {
    design = design_for(scene);
    springs = springs_as_solved(scene, *design);
    return springs;
  };
  Answer answer =
      scene.definition.msm.real_time
          ? solve_side(take_springs,
                       [&](const msm::SpringBody& body) {
                         return with_fields(scene, body, msm::come_to_rest(scene, body, n_threads, limits));
                       })
          : solve_side(
                [&] {
                  take_springs();
                  return msm::Model(scene, springs, {msm::Path::automatic, n_threads});
                },
                [&](msm::Model& model) {
                  return with_fields(
                      scene, springs,
                      model.solve(settings, stress ? start_points(*stress, scene.mesh) : msm::Points{}));
                });
  hold_against_loads(scene, answer,
                     [&](const cases::Solution& solution) { msm::fields(scene, springs, solution); });
  if (answer.solution.from_equilibrium) { // outside of the time that the iterations took
    cases::Scene in_equilibrium = scene;
    in_equilibrium.definition.msm.solver = cases::Solver::newton;
    in_equilibrium.definition.msm.relaxation.reset();
    in_equilibrium.definition.msm.real_time.reset();
    add_distance(answer.solution, "the same springs", [&] {
      return msm::Model(in_equilibrium, springs, {msm::Path::automatic, n_threads})
          .solve(settings)
          .displacement;
    });
  }
  return answer;
}

} // namespace springproof::compare
