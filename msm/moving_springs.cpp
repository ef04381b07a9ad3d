#include "msm/moving_springs.hpp"

#include "cases/scene/masses.hpp"

#include <algorithm>

namespace springproof::msm {

namespace {

bool is_damped(const cases::Scene& scene) {
  const auto& regions = scene.definition.region_materials;
  return scene.definition.material_dynamics.stiffness_damping > 0 ||
         std::any_of(regions.begin(), regions.end(),
                     [](const auto& region) { return region.dynamics.stiffness_damping > 0; });
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

SpringBody damping_springs(const cases::Scene& scene, const SpringBody& springs) {
  if (!is_damped(scene)) return {};
  return scaled(springs, scene.mesh.cells.size(),
                [&](std::size_t cell) { return cases::dynamics_of(scene, cell).stiffness_damping; });
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
