#include "compare/solve/design_by_shape.hpp"

#include "cases/scene/regions.hpp"
#include "cases/scene/thickness.hpp"
#include "compare/solve/springs.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "msm/design/by_shape.hpp"
#include "msm/design/midline.hpp"
#include "msm/design/multi_load.hpp"
#include "msm/design/patch.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

using cases::index;
using D = cases::Design;

bool is_fitted(D design) {
  return design == D::hybrid || design == D::matched || design == D::midline;
}
bool is_published(D design) {
  return design == D::van_gelder || design == D::lloyd || design == D::biquadratic;
}

/// What cells of a material have in common.
struct OfMaterial {
  msm::DesignRequest request;
  msm::DesignResult in_cube; ///< the same design of a cube: its law
  cases::LinearElastic at_rest;
  mechanics::ElasticModuli moduli;
  std::optional<msm::Exponents> exponents;
};

OfMaterial of_material(const cases::Scene& scene, const cases::Material& material) {
  const cases::Msm& options = scene.definition.msm;
  OfMaterial all{design_request(material, msm::cube(1), options), {}, {}, {}, {}};
  all.in_cube = msm::design(all.request);
  all.at_rest = msm::small_strain_material(material);
  if (options.design != D::van_gelder && options.design != D::lloyd && options.design != D::uniform)
    all.moduli = msm::elastic_moduli(all.request);
  all.exponents = all.in_cube.stiffness.exponents;
  if (all.exponents && scene.mesh.shape == cases::CellShape::tetrahedron) {
    // Edges have all directions alike: one exponent for all of them.
    double p = all.exponents->by_kind[0];
    if (!options.exponent) {
      const double nu = mechanics::linear_elastic(all.moduli.mu, all.moduli.kappa).poissons_ratio;
      p = msm::closed_form_exponent(msm::second_order_coefficient(material, nu), all.moduli,
                                    msm::split(all.request));
    }
    all.exponents->by_kind = {p, p, p};
  }
  return all;
}

/// Energies of strains per rest volume of the cells of one material, volume terms by cell.
msm::Elasticity elasticity_of(const cases::Scene& scene, const std::vector<msm::CellTerms>& cells,
                              int material) {
  msm::Elasticity sum = msm::Elasticity::Zero();
  double all = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (cases::material_of(scene, c) != material) continue;
    const cases::CellCorners corners = cases::cell_corners(scene.mesh, c);
    const double volume = cases::cell_volume(corners);
    sum += volume * msm::cell_elasticity(cells[c], corners);
    all += volume;
  }
  return sum / all;
}

/// Midlines take over a part of the edges beside them.
void add_midlines(msm::CellTerms& cell, double edge_part) {
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (std::size_t e = 0; e < 4; ++e) { // cell_edges has four along each axis
      double& stiffness = cell.springs[4 * index(axis) + e].stiffness;
      sum += stiffness;
      stiffness *= edge_part;
    }
    cell.midlines.push_back({axis, (1 - edge_part) * sum});
  }
}

std::string fit_text(const msm::ShapeFit& fit) {
  return fmt::format(
      "springs cannot follow the shapes of this mesh: the energies of strains err by {:.2g} % in the "
      "median cell and by {:.2g} % in the worst, as root mean squares over strains; with the forces "
      "that uniform strains leave on nodes by {:.2g} % over the mesh, where the best springs of single "
      "cells err by {:.2g} %. A grid of cubes (shape = \"surface\" with fill = \"cubes\") has the "
      "material's moduli",
      100 * fit.median_misfit, 100 * fit.worst_misfit, 100 * fit.over_the_mesh, 100 * fit.cell_by_cell);
}

/// The stiffnesses and volume terms of hybrid, with the midlines of that design.
std::vector<msm::CellTerms> fitted(const cases::Scene& scene, const std::vector<OfMaterial>& materials,
                                   msm::DesignResult& result) {
  const cases::Msm& options = scene.definition.msm;
  msm::FitRequest request{{}, msm::split(materials.front().request)};
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    request.moduli.push_back(materials[index(cases::material_of(scene, c))].moduli);
  for (const cases::Fixed& plane : scene.definition.symmetry) // named "x-" and the like
    for (const int node : cases::select_on_planes(scene.mesh, {plane.region.name}).nodes)
      request.axes_of_node[node] |= 1 << (plane.region.name[0] - 'x');
  msm::ShapeFit fit = msm::fit_by_shape(scene.mesh, request);
  if (!(fit.over_the_mesh <= msm::told_moduli_misfit)) result.warnings.push_back(fit_text(fit));
  if (fit.n_loose_nodes > 0)
    result.warnings.push_back(
        fmt::format("{} nodes are held in fewer than three directions by their springs: "
                    "their cells are too flat, and a finer or better mesh is needed",
                    fit.n_loose_nodes));
  if (options.design != D::midline) return fit.cells;
  if (scene.mesh.shape == cases::CellShape::tetrahedron) {
    result.warnings.push_back("tetrahedra have no opposite faces: the springs of midline are matched's here");
    return fit.cells;
  }
  const std::vector<int> across = options.beta ? std::vector<int>()
                                               : cases::cells_across(scene.mesh, scene.definition.symmetry,
                                                                     msm::DesignRequest::many_cells);
  for (std::size_t c = 0; c < fit.cells.size(); ++c) {
    const double beta = options.beta ? *options.beta : msm::default_beta(across[c]);
    const double nu = mechanics::linear_elastic(request.moduli[c].mu, request.moduli[c].kappa).poissons_ratio;
    add_midlines(fit.cells[c], msm::edge_part(nu, request.split, beta));
  }
  return fit.cells;
}

void check_design(const cases::Scene& scene) {
  const cases::Msm& options = scene.definition.msm;
  if (!is_fitted(options.design) && !is_published(options.design) && options.design != D::uniform)
    throw cases::InputError(
        options.where, "design: on tetrahedra it must be \"hybrid\" | \"matched\" | \"midline\" (which is "
                       "matched there) | \"uniform\" | \"van_gelder\" | \"lloyd\" | \"biquadratic\" | "
                       "\"network\"; the others are for hexahedra");
  if (options.design == D::uniform && options.uniform_stiffness) return;
  const auto materials = cases::materials_of(scene.definition);
  if (!std::all_of(materials.begin(), materials.end(), cases::is_isotropic))
    throw cases::InputError(options.where, "springs on tetrahedra are for isotropic materials; use a grid of "
                                           "cubes along the fibre");
}

} // namespace

bool is_designed_by_shape(const cases::Scene& scene) {
  const D design = scene.definition.msm.design;
  if (design == D::network) return false;
  if (scene.mesh.shape == cases::CellShape::tetrahedron) return true;
  const auto materials = cases::materials_of(scene.definition);
  return !scene.mesh.grid && is_fitted(design) &&
         std::all_of(materials.begin(), materials.end(), cases::is_isotropic);
}

msm::DesignResult design_by_shape(const cases::Scene& scene) {
  const cases::Msm& options = scene.definition.msm;
  if (scene.mesh.shape == cases::CellShape::tetrahedron) check_design(scene);
  std::vector<OfMaterial> materials;
  for (const cases::Material& material : cases::materials_of(scene.definition))
    materials.push_back(of_material(scene, material));
  msm::DesignResult result;
  std::vector<msm::CellTerms> cells;
  const auto at_rest = [&](std::size_t c) { return materials[index(cases::material_of(scene, c))].at_rest; };
  if (is_fitted(options.design)) {
    cells = fitted(scene, materials, result);
  } else if (options.design == D::uniform) {
    std::vector<double> youngs_modulus;
    for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
      youngs_modulus.push_back(at_rest(c).youngs_modulus);
    std::optional<double> stiffness;
    if (options.uniform_stiffness) stiffness = 1e-3 * *options.uniform_stiffness;
    cells = msm::uniform_by_shape(scene.mesh, youngs_modulus, stiffness);
  } else {
    for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
      const cases::CellCorners x = cases::cell_corners(scene.mesh, c);
      cases::LinearElastic material = at_rest(c);
      if (options.design == D::biquadratic)
        material = mechanics::linear_elastic(materials[index(cases::material_of(scene, c))].moduli.mu,
                                             materials[index(cases::material_of(scene, c))].moduli.kappa);
      cells.push_back(msm::in_tetrahedron(options.design, {x[0], x[1], x[2], x[3]}, material));
    }
  }
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const msm::DesignResult& cube = materials[m].in_cube;
    for (const std::string& warning : cube.warnings)
      if (!cube.misfit || warning != cube.misfit->text) result.warnings.push_back(warning);
    const msm::Elasticity elasticity = elasticity_of(scene, cells, static_cast<int>(m));
    if (m == 0) result.moduli = msm::averaged_moduli(elasticity);
    const auto wanted = msm::elasticity_at_rest(cases::materials_of(scene.definition)[m]);
    if (!wanted || !elasticity.allFinite()) continue;
    const msm::ModuliMisfit misfit = msm::moduli_misfit(elasticity, *wanted);
    if (!(misfit.largest <= msm::told_moduli_misfit)) result.warnings.push_back(misfit.text);
    if (!(result.misfit && misfit.largest <= result.misfit->largest)) result.misfit = misfit;
  }
  msm::BodyTerms body;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const OfMaterial& own = materials[index(cases::material_of(scene, c))];
    if (own.exponents) msm::set_exponents(cells[c], *own.exponents);
    body.kind_of_cell.push_back(static_cast<int>(c));
  }
  body.kinds = std::move(cells);
  result.stiffness.exponents = materials.front().exponents;
  result.springs = std::move(body);
  return result;
}

} // namespace springproof::compare
