#include "fem_reference/grid/inertia.hpp"

#include "cases/scene/loads.hpp"
#include "fem_reference/grid/on_grid.hpp"

namespace springproof::fem_reference::grid {

namespace {

using cases::index;

/// Calls action(cell of the scene's mesh, its entry) for the cells that a rank holds.
template<class Action>
void for_each_cell(const cases::Scene& scene, const Places& places, const Action& action) {
  const cases::Mesh& mesh = scene.mesh;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const Place lower = places.of(mesh.nodes[index(mesh.cells[c][0])]);
    const int layer = lower.z() - places.body.slab.first_of_grid();
    if (layer < 0 || layer >= places.body.cells[2]) continue;
    action(c, index(places.body.layout.cell(lower.x(), lower.y(), layer)));
  }
}

} // namespace

Inertia::Inertia(const cases::Scene& scene, const Places& places, int n_threads)
    : body_(places.body), n_threads_(n_threads),
      is_lumped_(scene.definition.fem.mass == cases::ElementMass::lumped) {
  const std::size_t n_entries = index(body_.layout.n_cell_entries()) + 16;
  for (std::vector<double>* cells : {&mass_of_cell_, &damped_mass_of_cell_, &step_masses_, &factored_})
    cells->assign(n_entries, 0.);
  const double volume = body_.spacing.prod();
  bool is_stiffness_damped = false;
  for_each_cell(scene, places, [&](std::size_t cell, std::size_t entry) {
    const auto dynamics = cases::dynamics_of(scene, cell);
    mass_of_cell_[entry] = dynamics.density * volume;
    damped_mass_of_cell_[entry] = dynamics.mass_damping * mass_of_cell_[entry];
    is_stiffness_damped = is_stiffness_damped || dynamics.stiffness_damping > 0;
  });
  const cases::NodeMasses added = cases::added_masses(scene);
  if (!added.empty()) node_mass_.setZero(3 * body_.layout.size);
  for (const auto& [node, mass] : added) {
    const Place at = places.of(scene.mesh.nodes[index(node)]);
    for (int c = 0; places.holds(at) && c < 3; ++c)
      node_mass_[c * body_.layout.size + places.entry(at)] = mass;
  }
  if (is_stiffness_damped) make_damping_body(scene, places);
}

void Inertia::make_damping_body(const cases::Scene& scene, const Places& places) {
  damping_body_ = std::make_unique<Body>(body_);
  Body& damping = *damping_body_;
  const std::size_t n_entries = index(damping.layout.n_cell_entries());
  damping.law = Law::small_strain; // what every isotropic law is at rest
  damping.n_parameters = 2;
  damping.parameters.assign(2 * n_entries + 16, 0.);
  const auto materials = cases::materials_of(scene.definition);
  for_each_cell(scene, places, [&](std::size_t cell, std::size_t entry) {
    const double factor = cases::dynamics_of(scene, cell).stiffness_damping;
    const mechanics::ElasticModuli moduli = moduli_at_rest(materials[index(cases::material_of(scene, cell))]);
    // A modulus of 0 has no meaning for the kernels; a cell without weight has no damping either.
    if (!(factor > 0)) damping.weight[entry] = 0;
    damping.parameters[entry] = factor * moduli.mu;
    damping.parameters[n_entries + entry] = factor * moduli.kappa;
  });
  force_.setZero(3 * body_.layout.size);
  condensed_.setZero(3 * body_.layout.size);
}

void Inertia::factor(const Factors& factors, std::vector<double>& masses) const {
  for (std::size_t c = 0; c < masses.size(); ++c)
    masses[c] = factors.mass * mass_of_cell_[c] + factors.damping * damped_mass_of_cell_[c];
}

bool Inertia::set_step(const Factors& factors) {
  if (factors.mass == step_.mass && factors.damping == step_.damping) return false;
  step_ = factors;
  factor(factors, step_masses_);
  step_node_masses_ = factors.mass * node_mass_;
  return true;
}

Masses<double> Inertia::step_masses() const {
  return of_kind(step_masses_);
}

Masses<double> Inertia::of_kind(const std::vector<double>& masses) const {
  return {masses.data(), is_lumped_ ? 0. : 1., is_lumped_ ? 1. : 0.};
}

std::optional<Cells> Inertia::step_damping() const {
  if (!damping_body_ || step_.damping == 0) return std::nullopt;
  return damping_view(step_.damping);
}

Cells Inertia::damping_view(double factor) const {
  Cells view = damping_body_->view();
  view.point_volume *= factor;
  return view;
}

void Inertia::add_product(const Factors& factors, const Field<double>& field, Field<double>& product) {
  factor(factors, factored_);
  const Masses<double> masses = of_kind(factored_);
  for_each_layer(body_.slab, n_threads_,
                 [&](int k) { kernels().mass(body_.layout, masses, field.data(), product.data(), k); });
  if (node_mass_.size() > 0) product += factors.mass * node_mass_.cwiseProduct(field);
  if (!damping_body_ || factors.damping == 0) return;
  // The linear body's force at this displacement, with the unknowns of its cells that belong to it.
  const Cells view = damping_view(factors.damping);
  const std::vector<double> at_rest(index(damping_body_->n_internal()), 0.);
  const bool is_condensed = view.internal != Internal::none;
  Field<double>& force = is_condensed ? condensed_ : force_;
  force_.setZero();
  condensed_.setZero();
  const ForceFields fields{field.data(), at_rest.data(), force_.data(),
                           is_condensed ? condensed_.data() : nullptr, nullptr};
  check_layers(body_.slab, n_threads_,
               [&](int k, Checks& checks) { kernels().force(view, fields, k, checks); });
  product += force;
}

} // namespace springproof::fem_reference::grid
