#include "msm/moving_springs.hpp"

#include "cases/scene/loads.hpp"
#include "msm/tangent.hpp"

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

mechanics::VibratingBody vibrating_body(const cases::Scene& scene, const Lattice& lattice) {
  Tangent tangent(lattice, cases::constrained_dofs(scene));
  mechanics::VibratingBody body;
  body.stiffness = tangent.assemble(lattice.rest, TransverseTerm::exact).selfadjointView<Eigen::Lower>();
  const std::vector<double> masses = cases::point_masses(scene);
  const std::vector<int>& number = tangent.free_number();
  body.mesh_dof.resize(cases::index(tangent.n_free()));
  std::vector<Eigen::Triplet<double>> diagonal;
  for (std::size_t dof = 0; dof < number.size(); ++dof) {
    if (number[dof] < 0) continue;
    diagonal.emplace_back(number[dof], number[dof], masses[dof / 3]);
    body.mesh_dof[cases::index(number[dof])] = static_cast<Eigen::Index>(dof);
  }
  body.mass.resize(tangent.n_free(), tangent.n_free());
  body.mass.setFromTriplets(diagonal.begin(), diagonal.end());
  return body;
}

MovingSprings::Entries MovingSprings::entries_of(const Problem& problem, const Inertia& inertia,
                                                 const std::function<Vector(const Points&)>& on_free) {
  const auto of_points = [&](const std::vector<double>& values) {
    Points points;
    for (const double value : values) points.push_back(Eigen::Vector3d::Constant(value));
    return on_free(points);
  };
  Entries entries{of_points(inertia.mass),
                  of_points(inertia.mass_damping),
                  {},
                  of_points(std::vector<double>(inertia.mass.size(), 1))};
  for (const auto& [history, force] : inertia.loads)
    entries.loads.emplace_back(history, on_free(problem.on_all_points(force)));
  return entries;
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
