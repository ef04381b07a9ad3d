#include "msm/moving_springs.hpp"

#include "cases/scene/masses.hpp"

#include <algorithm>
#include <map>

namespace springproof::msm {

namespace {

double damping_of(const cases::Scene& scene, std::size_t cell) {
  return cases::dynamics_of(scene, cell).stiffness_damping;
}

bool is_damped(const cases::Scene& scene) {
  const auto& regions = scene.definition.region_materials;
  return scene.definition.material_dynamics.stiffness_damping > 0 ||
         std::any_of(regions.begin(), regions.end(),
                     [](const auto& region) { return region.dynamics.stiffness_damping > 0; });
}

Lattice without_springs(const cases::Scene& scene) {
  Lattice none;
  none.rest = scene.mesh.nodes.to_vector();
  return none;
}

} // namespace

Inertia make_inertia(const cases::Scene& scene, Lattice damping) {
  Inertia inertia;
  inertia.mass = cases::point_masses(scene);
  inertia.mass_damping = cases::point_mass_damping(scene);
  inertia.damping = std::move(damping);
  for (const auto& applied : scene.loads) {
    std::vector<cases::NodeVector> force =
        applied.load.on() == cases::loads::On::masses
            ? cases::weights(inertia.mass, cases::acceleration_of(applied.load))
            : cases::loaded_nodes(scene, {applied});
    inertia.loads.push_back({applied.load.history, std::move(force)});
  }
  return inertia;
}

std::vector<CellStiffness> damping_stiffness(const cases::Scene& scene,
                                             const std::vector<CellStiffness>& stiffness) {
  if (!is_damped(scene)) return {};
  if (stiffness.size() == 1 && scene.material_of_cell.empty())
    return {scaled(stiffness.front(), scene.definition.material_dynamics.stiffness_damping)};
  std::vector<CellStiffness> damped;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    damped.push_back(scaled(stiffness[stiffness.size() == 1 ? 0 : c], damping_of(scene, c)));
  return damped;
}

Lattice damping_lattice(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness) {
  if (!is_damped(scene)) return without_springs(scene);
  return make_lattice(scene.mesh, damping_stiffness(scene, stiffness));
}

Lattice damping_lattice(const cases::Scene& scene, const BodyTerms& terms) {
  if (!is_damped(scene)) return without_springs(scene);
  BodyTerms damped;
  damped.boundary = terms.boundary;
  std::map<std::pair<int, double>, int> kinds; // of a kind of cells and its damping
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
    const int kind = terms.kind_of_cell.empty() ? 0 : terms.kind_of_cell[c];
    const double beta = damping_of(scene, c);
    const auto [known, is_new] = kinds.try_emplace({kind, beta}, static_cast<int>(kinds.size()));
    if (is_new) damped.kinds.push_back(scaled(terms.kinds[cases::index(kind)], beta));
    damped.kind_of_cell.push_back(known->second);
  }
  return make_lattice(scene.mesh, damped);
}

Lattice damping_lattice(const cases::Scene& scene, Lattice springs) {
  if (!is_damped(scene)) return without_springs(scene);
  const double beta = scene.definition.material_dynamics.stiffness_damping;
  for (Link& link : springs.links) link.spring.stiffness *= beta;
  for (VolumeCell& cell : springs.volume_cells) cell.stiffness *= beta;
  for (Tetrahedron& tetrahedron : springs.tetrahedra) tetrahedron.stiffness *= beta;
  return springs;
}

void MovingSprings::external_force(double time, Vector& force) {
  force.setZero(entries_.mass.size());
  for (const mechanics::LoadInTime& load : entries_.loads) load.add(time, force);
}

void MovingSprings::set_step(const mechanics::StepTerms& terms) {
  terms_.emplace(terms);
  diagonal_ = terms.mass * entries_.mass + terms.damping * entries_.mass_damping;
}

void MovingSprings::residual(const Vector& at, double /*load_factor*/, mechanics::Expect expect,
                             Vector& residual) {
  spring_residual(at, expect, residual);
  // (mass M + damping C) (at - origin)
  residual += terms_->force - diagonal_.cwiseProduct(at - terms_->origin);
  if (pull_) pull_->add_force(at, residual);
  if (!has_stiffness_damping() || terms_->damping == 0) return;
  moved_ = at - terms_->origin;
  product_.setZero(at.size());
  add_stiffness_damping(moved_, product_);
  residual -= terms_->damping * product_;
}

/// Damping by stiffness joins free degrees of freedom and supports that move: half of the form in the former,
/// all of what the latter add. What they store alone stays the same in a step.
double MovingSprings::energy(const Vector& at, double /*load_factor*/) {
  moved_ = at - terms_->origin;
  added_ = diagonal_.cwiseProduct(moved_);
  double added = dot(moved_, added_) / 2;
  if (has_stiffness_damping() && terms_->damping != 0) {
    added_ = moved_ - 0.5 * entries_.free.cwiseProduct(moved_);
    product_.setZero(at.size());
    add_stiffness_damping(added_, product_);
    added += terms_->damping * dot(moved_, product_);
  }
  if (pull_) added += pull_->energy(at);
  return spring_energy(at) + added - dot(terms_->force, at);
}

} // namespace springproof::msm
