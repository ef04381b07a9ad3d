#include "fem_reference/backend.hpp"

#include "cases/case/elements.hpp"
#include "cases/case/error.hpp"
#include "fem_reference/grid/on_grid.hpp"

#include <cmath>

namespace springproof::fem_reference {

namespace {

/// Nodes of the elements from which the grid's backend is used. Below, a compact body takes milliseconds
/// either way, and a slender one on a hard path less when it is factorised: bar_buckling_imperfect, 225
/// nodes, 0.95 s against 1.7.
constexpr double grid_from = 300;

} // namespace

Backend choose_backend(const cases::Scene& scene, double n_nodes) {
  if (!grid::is_on_grid(scene)) return Backend::assembled;
  const bool can_factorise = takes_factorisation(n_nodes, scene.definition.fem);
  const bool is_hard = can_factorise && (grid::bulk_over_shear(scene) > most_incompressible ||
                                         scene.mesh.grid->slenderness() > cases::Grid::thin);
  return n_nodes < grid_from || is_hard ? Backend::assembled : Backend::grid;
}

int n_halvings(const cases::Fem& fem) {
  return fem.refine + cases::facts_of(fem.element).degree - 1;
}

double n_element_nodes(const cases::Fem& fem, double n_nodes) {
  return n_nodes * std::pow(8, n_halvings(fem));
}

Backend backend_of(const cases::Scene& scene, Backend asked) {
  if (asked == Backend::automatic) return choose_backend(scene, n_element_nodes(scene));
  if (asked == Backend::grid && !grid::is_on_grid(scene))
    throw cases::InputError(scene.definition.fem.where,
                            "the grid's backend needs a body that is a grid of cells, an isotropic material, "
                            "no q2_p1 and no tools; beside [dynamics] no q2 and no prony");
  return asked;
}

bool takes_factorisation(double n_nodes, const cases::Fem& fem) {
  return cases::facts_of(fem.element).is_mixed || 3 * n_nodes <= double(direct_solver_limit);
}

mechanics::EquilibriumSettings default_settings() {
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-10;
  settings.smallest_load_step = 1. / 512;
  settings.max_newton_per_step = 14;
  settings.easy_newton_per_step = 6;
  settings.max_convexified_per_step = 0; // the tangent is the exact one
  settings.max_newton_iterations = 300;
  settings.stability = mechanics::Stability::report;
  return settings;
}

} // namespace springproof::fem_reference
