#include "msm/moving_springs.hpp"

#include "cases/case/error.hpp"
#include "cases/mesh/mesh.hpp"
#include "cases/scene/loads.hpp"
#include "mechanics/dynamics/loads_in_time.hpp"
#include "mechanics/real_time/step_equation.hpp"
#include "mechanics/shape_products.hpp"
#include "msm/tangent.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace springproof::msm {

namespace {

bool is_consistent(const cases::Scene& scene) {
  return scene.definition.msm.mass == cases::PointMass::consistent;
}

/// Each cell's mass, t.
std::vector<double> cell_masses(const cases::Scene& scene) {
  std::vector<double> masses;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    masses.push_back(cases::dynamics_of(scene, c).density *
                     cases::cell_volume(cases::cell_corners(scene.mesh, c)));
  return masses;
}

} // namespace

std::vector<Eigen::Triplet<double>> masses_beyond_lumped(const cases::Mesh& mesh,
                                                         const std::vector<double>& cell_mass) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t c = 0; c < cell_mass.size(); ++c) {
    const cases::CellCorners corners = cases::cell_corners(mesh, c);
    Eigen::MatrixXd masses = mechanics::shape_products(corners, cell_mass[c] / cases::cell_volume(corners));
    masses.diagonal().array() -= cell_mass[c] / static_cast<double>(corners.size());
    const cases::CellNodes nodes = mesh.cells[c];
    for (int a = 0; a < masses.rows(); ++a)
      for (int b = 0; b < masses.cols(); ++b)
        for (int i = 0; i < 3; ++i)
          entries.emplace_back(3 * nodes[cases::index(a)] + i, 3 * nodes[cases::index(b)] + i, masses(a, b));
  }
  return entries;
}

Inertia make_inertia(const cases::Scene& scene, Lattice damping) {
  Inertia inertia;
  inertia.mass = cases::point_masses(scene);
  inertia.mass_damping = cases::point_mass_damping(scene);
  inertia.damping = std::move(damping);
  if (is_consistent(scene)) {
    inertia.cell_mass = cell_masses(scene);
    for (std::size_t c = 0; c < inertia.cell_mass.size(); ++c)
      inertia.cell_mass_damping.push_back(cases::dynamics_of(scene, c).mass_damping * inertia.cell_mass[c]);
  }
  for (mechanics::LoadOnNodes& load : mechanics::loads_in_time(scene, inertia.mass))
    inertia.loads.push_back({std::move(load.history), std::move(load.force)});
  return inertia;
}

SpringBody damping_springs(const cases::Scene& scene, const SpringBody& springs) {
  if (!cases::has_stiffness_damping(scene.definition)) return {};
  return scaled(springs, scene.mesh.cells.size(),
                [&](std::size_t cell) { return cases::dynamics_of(scene, cell).stiffness_damping; });
}

mechanics::VibratingBody vibrating_body(const cases::Scene& scene, const Lattice& lattice) {
  Tangent tangent(lattice, cases::constrained_dofs(scene));
  mechanics::VibratingBody body;
  body.stiffness = tangent.assemble(lattice.rest, Clamp::no).selfadjointView<Eigen::Lower>();
  const std::vector<double> masses = cases::point_masses(scene);
  const std::vector<int>& number = tangent.free_number();
  body.mesh_dof.resize(cases::index(tangent.n_free()));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t dof = 0; dof < number.size(); ++dof) {
    if (number[dof] < 0) continue;
    entries.emplace_back(number[dof], number[dof], masses[dof / 3]);
    body.mesh_dof[cases::index(number[dof])] = static_cast<Eigen::Index>(dof);
  }
  if (is_consistent(scene))
    for (const auto& joined : masses_beyond_lumped(scene.mesh, cell_masses(scene)))
      if (const int row = number[cases::index(joined.row())], column = number[cases::index(joined.col())];
          row >= 0 && column >= 0)
        entries.emplace_back(row, column, joined.value());
  body.mass.resize(tangent.n_free(), tangent.n_free());
  body.mass.setFromTriplets(entries.begin(), entries.end());
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
  seen_at_.resize(0);
}

void MovingSprings::end_step(const Vector& at, double /*length*/) {
  if (!contact_) return;
  largest_press_ = std::max(largest_press_, size_of_press(at));
  if (seen_at_.size() != at.size() || seen_at_ != at)
    residual(at, 0, mechanics::Expect::residual, unbalanced_);
  else
    unbalanced_ = seen_; // a step ends where Newton's method was last
  end_ = terms_->time;
  contact_->end_step(displacements(at), terms_->time);
}

std::optional<mechanics::NonlinearProblem::Solved> MovingSprings::solve_at(Vector& at, double load_factor) {
  if (!method_) return std::nullopt;
  work_.linear_iterations += method_(*terms_, diagonal_, pull_ ? &*pull_ : nullptr, at);
  const double left = terms_->is_substep ? 0 : size(NonlinearProblem::residual(at, load_factor), at).relative;
  if (!std::isfinite(left) || !at.allFinite()) throw cases::SolveError(mechanics::no_finite_place);
  return Solved{true, 0, left};
}

void MovingSprings::residual(const Vector& at, double /*load_factor*/, mechanics::Expect expect,
                             Vector& residual) {
  spring_residual(at, expect, residual);
  // (mass M + damping C) (at - origin)
  residual += terms_->force - diagonal_.cwiseProduct(at - terms_->origin);
  if (pull_) pull_->add_force(at, residual);
  if (contact_)
    for (const PressedNode& node : pressed_nodes(at, Clamp::yes))
      for (int c = 0; c < 3; ++c)
        if (const Eigen::Index entry = node.entries[cases::index(c)]; entry >= 0)
          residual[entry] += node.force[c];
  if (joins_nodes()) {
    moved_ = terms_->origin - at;
    add_joined(terms_->mass, terms_->damping, moved_, residual);
  }
  if (!contact_) return;
  seen_at_ = at;
  seen_ = residual;
}

/// Inertia joins free degrees of freedom and supports that move: half of the form in the former, all of what
/// the latter add. What they store alone stays the same in a step.
double MovingSprings::energy(const Vector& at, double /*load_factor*/) {
  moved_ = at - terms_->origin;
  added_ = diagonal_.cwiseProduct(moved_);
  double added = dot(moved_, added_) / 2;
  if (joins_nodes()) {
    added_ = moved_ - 0.5 * entries_.free.cwiseProduct(moved_);
    product_.setZero(at.size());
    add_joined(terms_->mass, terms_->damping, added_, product_);
    added += dot(moved_, product_);
  }
  if (pull_) added += pull_->energy(at);
  if (contact_) added += contact_->energy(displacements(at), terms_->time);
  return spring_energy(at) + added - dot(terms_->force, at);
}

void MovingSprings::press_by(mechanics::Contact contact, std::vector<std::array<Eigen::Index, 3>> entries) {
  contact_.emplace(std::move(contact));
  entries_of_node_ = std::move(entries);
}

mechanics::DisplacementAt MovingSprings::displacements(const Vector& at) const {
  return [&](int node) {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c)
      if (const Eigen::Index entry = entries_of_node_[cases::index(node)][cases::index(c)]; entry >= 0)
        value[c] = at[entry];
    return value;
  };
}

void MovingSprings::follow_tools(double from_time, const Vector& from, Vector& guess) const {
  if (!contact_) return;
  contact_->for_each_way_along(displacements(from), from_time, displacements(guess), terms_->time,
                               [&](int node, const Eigen::Vector3d& way) {
                                 for (int c = 0; c < 3; ++c)
                                   if (const Eigen::Index entry =
                                           entries_of_node_[cases::index(node)][cases::index(c)];
                                       entry >= 0 && entries_.free[entry] != 0)
                                     guess[entry] += way[c];
                               });
}

double MovingSprings::size_of_press(const Vector& at) const {
  double squared = 0;
  for (const PressedNode& node : pressed_nodes(at, Clamp::yes)) squared += node.force.squaredNorm();
  return std::sqrt(squared);
}

std::vector<cases::ToolContact> MovingSprings::tools_at(double time, const Vector& at) const {
  if (!contact_) return {};
  return contact_->found(displacements(at), time,
                         end_ == time ? displacements(unbalanced_) : mechanics::DisplacementAt{});
}

std::vector<MovingSprings::PressedNode> MovingSprings::pressed_nodes(const Vector& at, Clamp clamp) const {
  std::vector<PressedNode> nodes;
  contact_->for_each_pressed(
      displacements(at), terms_->time, [&](const mechanics::Contact::Pressed& pressed) {
        std::array<Eigen::Index, 3> entries = entries_of_node_[cases::index(pressed.node)];
        for (Eigen::Index& entry : entries)
          if (entry >= 0 && entries_.free[entry] == 0) entry = -1;
        nodes.push_back(
            {entries, pressed.force, clamp == Clamp::yes ? pressed.stiffness : pressed.tangent()});
      });
  return nodes;
}

template<class Real>
Eigen::Vector3d Pull::place(const VectorIn<Real>& displacement) const {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c)
    for (const Entry& entry : entries_[cases::index(c)])
      mean[c] += entry.weight * static_cast<double>(displacement[entry.at]);
  return mean;
}

template<class Real>
void Pull::add(const Eigen::Vector3d& force, VectorIn<Real>& to) const {
  for (int c = 0; c < 3; ++c)
    for (const Entry& entry : entries_[cases::index(c)])
      if (entry.is_free) to[entry.at] += static_cast<Real>(entry.weight * force[c]);
}

template Eigen::Vector3d Pull::place(const Vector&) const;
template void Pull::add(const Eigen::Vector3d&, Vector&) const;
template Eigen::Vector3d Pull::place(const VectorIn<float>&) const;
template void Pull::add(const Eigen::Vector3d&, VectorIn<float>&) const;

double Pull::size(const Vector& displacement) const {
  const Eigen::Vector3d pulls = force(displacement);
  double squared = 0;
  for (int c = 0; c < 3; ++c)
    for (const Entry& entry : entries_[cases::index(c)])
      if (entry.is_free) squared += std::pow(entry.weight * pulls[c], 2);
  return std::sqrt(squared);
}

template<class Real>
void WithPull<Real>::prepare(const Pull& pull, Eigen::Index size,
                             const std::function<void(const VectorIn<Real>&, VectorIn<Real>&)>& invert) {
  Eigen::Matrix3d compliance; // W^T Y, mm/N
  for (int c = 0; c < 3; ++c) {
    unit_.setZero(size);
    pull.add(Eigen::Vector3d::Unit(c), unit_);
    VectorIn<Real>& column = columns_[cases::index(c)];
    column.setZero(size);
    invert(unit_, column);
    compliance.col(c) = pull.place(column);
  }
  const Eigen::Matrix3d symmetric = (compliance + compliance.transpose()) / 2; // but for rounding
  matters_ = !(pull.stiffness() * symmetric.trace() <= 1); // the trace bounds its largest eigenvalue
  inverse_ = (Eigen::Matrix3d::Identity() / pull.stiffness() + symmetric).inverse();
}

template<class Real>
void WithPull<Real>::correct(const Pull& pull, VectorIn<Real>& solution) const {
  const Eigen::Vector3d factors = inverse_ * pull.place(solution);
  for (int c = 0; c < 3; ++c) solution -= static_cast<Real>(factors[c]) * columns_[cases::index(c)];
}

template class WithPull<double>;
template class WithPull<float>;

} // namespace springproof::msm
