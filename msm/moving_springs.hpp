#pragma once

#include "mechanics/dynamics/dynamic_problem.hpp"
#include "mechanics/vibrating_body.hpp"
#include "msm/problem.hpp"
#include "msm/spring_body.hpp"
#include "msm/spring_laws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace springproof::msm {

template<class Real>
using VectorIn = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// A spring between a place of a body and one outside of it: force = stiffness (target - place(u)), on the
/// nodes that the place is a weighted mean of, by their weights. Displacements are vectors of a motion.
class Pull {
 public:
  struct Entry {
    Eigen::Index at; ///< in a vector
    double weight;
    bool is_free; ///< whether a force acts on it; what is constrained counts for the place alone
  };
  using Entries = std::array<std::vector<Entry>, 3>; ///< by component

  /// @param stiffness  N/mm, > 0
  Pull(Entries entries, double stiffness) : entries_(std::move(entries)), stiffness_(stiffness) {}

  /// @param target  displacement that the place is drawn to, mm
  void draw_to(const Eigen::Vector3d& target) { target_ = target; }

  double stiffness() const { return stiffness_; }
  const Eigen::Vector3d& target() const { return target_; }
  /// Displacement of the place, mm.
  template<class Real>
  Eigen::Vector3d place(const VectorIn<Real>& displacement) const;
  Eigen::Vector3d force(const Vector& displacement) const {
    return stiffness_ * (target_ - place(displacement));
  }

  /// stiffness |target - place(u)|²/2, N mm
  double energy(const Vector& displacement) const {
    return stiffness_ / 2 * (target_ - place(displacement)).squaredNorm();
  }
  /// Adds to `to`: to += force(u) . weights, N
  void add_force(const Vector& displacement, Vector& to) const { add(force(displacement), to); }
  /// Norm of these forces, N.
  double size(const Vector& displacement) const;
  /// Its tangent, of rank three: to += stiffness weights (weights . direction).
  template<class Real>
  void add_product(const VectorIn<Real>& direction, VectorIn<Real>& to) const {
    add(stiffness_ * place(direction), to);
  }

  /// Adds the force on free degrees of freedom to `to`, by the weights.
  template<class Real>
  void add(const Eigen::Vector3d& force, VectorIn<Real>& to) const;

  const Entries& entries() const { return entries_; }

 private:
  Entries entries_;
  double stiffness_;
  Eigen::Vector3d target_ = Eigen::Vector3d::Zero(); ///< mm
};

/// The inverse of a matrix with the tangent of a pull added, from the inverse without it (Woodbury's
/// formula):
///   (A + k W W^T)^-1 r = z - Y (1/k + W^T Y)^-1 W^T z,  z = A^-1 r,  Y = A^-1 W.
template<class Real>
class WithPull {
 public:
  /// @param invert  (right side, solution) by A, which is symmetric and positive definite
  /// @param size    size of a vector
  void prepare(const Pull& pull, Eigen::Index size,
               const std::function<void(const VectorIn<Real>&, VectorIn<Real>&)>& invert);
  /// Whether the pull makes its place more than twice as stiff. A weaker pull is left to conjugate gradients.
  bool matters() const { return matters_; }
  /// @param solution  by A, becomes that with the pull
  void correct(const Pull& pull, VectorIn<Real>& solution) const;

 private:
  std::array<VectorIn<Real>, 3> columns_;             ///< Y
  Eigen::Matrix3d inverse_ = Eigen::Matrix3d::Zero(); ///< inverse of 1/k + W^T Y
  bool matters_ = false;
  VectorIn<Real> unit_;
};

/// What makes a lattice move.
struct Inertia {
  std::vector<double> mass;         ///< t, one entry per point; lumped
  std::vector<double> mass_damping; ///< t/s, one entry per point: the part of C on the diagonal
  /// With consistent masses: t and t/s, one entry per cell of the mesh, whose matrix takes the place of its
  /// eighths in the lumped masses; else empty.
  std::vector<double> cell_mass, cell_mass_damping;
  Lattice damping; ///< its tangent at rest, in N s/mm, is the rest of C: springs of beta times k
  struct LoadInTime {
    cases::History history;
    std::vector<cases::NodeVector> force; ///< N, at a factor of 1
  };
  std::vector<LoadInTime> loads; ///< gravity among them
};

/// What consistent masses of a mesh's cells have beyond eighths on the diagonal, by degrees of freedom 3*node
/// + component.
/// @param cell_mass  t or t/s, one entry per cell; empty: no entries
std::vector<Eigen::Triplet<double>> masses_beyond_lumped(const cases::Mesh& mesh,
                                                         const std::vector<double>& cell_mass);

/// @param damping  the lattice of damping_springs()
Inertia make_inertia(const cases::Scene& scene, Lattice damping);

/// Springs whose tangent at rest is beta times that of a body's, cell by cell: it is linear in their
/// stiffness. Without stiffness_damping, none. A network is in a scene of one material.
SpringBody damping_springs(const cases::Scene& scene, const SpringBody& springs);

/// The vibrations of a scene's springs about rest: the lattice's tangent there, its masses.
mechanics::VibratingBody vibrating_body(const cases::Scene& scene, const Lattice& lattice);

/// The motion of a lattice with the forces of its static equations, on their vectors unless forces, energy,
/// supports and inverted cells are overridden.
class MovingSprings : public mechanics::DynamicProblem {
 public:
  /// Lumped inertia in the order of the vectors, 0 on constrained degrees of freedom.
  struct Entries {
    Vector mass, mass_damping;
    std::vector<mechanics::LoadInTime> loads;
    Vector free; ///< 1 on free degrees of freedom
  };
  /// @param on_free  values of points as a vector, 0 on constrained degrees of freedom
  static Entries entries_of(const Problem& problem, const Inertia& inertia,
                            const std::function<Vector(const Points&)>& on_free);
  /// @param springs  static equations of a problem of make_moving_problem(); must outlive this
  MovingSprings(mechanics::NonlinearProblem& springs, Entries entries)
      : springs_(springs), entries_(std::move(entries)) {}

  void mass_product(const Vector& motion, Vector& product) override {
    product = entries_.mass.cwiseProduct(motion);
    if (joins_nodes()) add_joined(1, 0, motion, product);
  }
  void damping_product(const Vector& motion, Vector& product) override {
    product = entries_.mass_damping.cwiseProduct(motion);
    if (joins_nodes()) add_joined(0, 1, motion, product);
  }
  void external_force(double time, Vector& force) override;
  /// Takes hold of the body, until let_go().
  Pull& hold(Pull pull) {
    pull_.emplace(std::move(pull));
    has_pull_changed();
    return *pull_;
  }
  void let_go() {
    if (!pull_) return;
    pull_.reset();
    has_pull_changed();
  }
  /// Remembers the size of the pull at the end of a step: residuals are relative to the largest one, too.
  /// (Before the end of a step a stiff spring has forces that mean nothing.)
  void remember_pull(const Vector& at) {
    if (pull_) largest_pull_ = std::max(largest_pull_, pull_->size(at));
  }
  /// The motion begins again: what has pulled, and what a method knows of earlier steps, are forgotten.
  void begin_anew() {
    largest_pull_ = largest_press_ = 0;
    end_.reset();
    method_ = fresh_method_;
  }
  /// Lets tools press the body from now on.
  /// @param entries  each node's places in a vector; -1: none
  void press_by(mechanics::Contact contact, std::vector<std::array<Eigen::Index, 3>> entries);
  /// What presses it; null: no tool.
  mechanics::Contact* contact() override { return contact_ ? &*contact_ : nullptr; }
  double largest_press() const override { return largest_press_; }
  std::vector<cases::ToolContact> tools_at(double time, const Vector& at) const override;
  void supports_at(double time, Vector& displacement) const override {
    springs_.move_supports(displacement, time);
  }
  void set_step(const mechanics::StepTerms& terms) override;
  void begin_motion(const Vector& /*at*/) override {
    if (contact_) contact_->forget();
  }
  bool settle(const Vector& at) override {
    return !contact_ || contact_->settle(displacements(at), terms_->time);
  }
  bool is_way_open(double from_time, const Vector& from, const Vector& to) const override {
    return !contact_ ||
           contact_->is_way_open(displacements(from), from_time, displacements(to), terms_->time);
  }
  void follow_tools(double from_time, const Vector& from, Vector& guess) const override;
  void end_step(const Vector& at, double length) override;
  /// Supports of a method of its own are where the step has them, and take nothing along.
  bool moves_supports() const override { return !method_ && springs_.moves_supports(); }

  /// Goes from `at`, whose supports are the step's, to where a method leaves the step's equation.
  /// @param inertia  lumped mass M + damping C, N/mm; 0 on constrained entries
  /// @param pull     what holds the body; null: nothing
  /// @return iterations
  using StepMethod = std::function<int(const mechanics::StepTerms& terms, const Vector& inertia,
                                       const Pull* pull, Vector& at)>;
  /// Makes steps by a method of its own from now on, in place of Newton's.
  void step_by(StepMethod method) { method_ = fresh_method_ = std::move(method); }
  /// @throws cases::SolveError where the method has left finite places
  std::optional<Solved> solve_at(Vector& at, double load_factor) override;

  using NonlinearProblem::direction;
  using NonlinearProblem::residual;
  void residual(const Vector& at, double load_factor, mechanics::Expect expect, Vector& residual) override;
  /// Residual over the largest of the motion's forces, all pulls and tools so far, and reactions where
  /// supports move.
  Size size(const Vector& residual, const Vector& at) override {
    double scale = std::max(terms_->scale, largest_pull_);
    if (pull_) scale = std::max(scale, pull_->size(at));
    if (contact_) scale = std::max({scale, largest_press_, size_of_press(at)});
    if (moves_supports()) scale = std::max(scale, reaction(at));
    return {relative(std::sqrt(dot(residual, residual)), scale)};
  }
  mechanics::Merit merit() const override { return mechanics::Merit::energy; }
  double energy(const Vector& at, double load_factor) override;
  std::optional<bool> is_stable(const Vector& /*at*/) override { return std::nullopt; }
  int n_inverted(const Vector& at) override { return springs_.n_inverted(at); }
  double dot(const Vector& left, const Vector& right) const override { return springs_.dot(left, right); }
  double largest(const Vector& of) const override { return springs_.largest(of); }
  bool any_rank(bool here) const override { return springs_.any_rank(here); }
  /// Whether a linear solver that iterates has ever come to no end.
  virtual bool has_failed() const { return false; }
  std::size_t n_unknowns() const override { return springs_.n_unknowns(); }
  Work work() const override {
    Work all = work_;
    all.force_evaluations = springs_.work().force_evaluations;
    return all;
  }

 protected:
  Work work_; ///< but for the evaluations of forces

  const Entries& entries() const { return entries_; }
  const mechanics::StepTerms& terms() const { return *terms_; }
  const std::optional<Pull>& pull() const { return pull_; }
  /// Called when the pull has changed: drops what was computed for the earlier one.
  virtual void has_pull_changed() {}
  /// What a tool adds at a node that it presses.
  struct PressedNode {
    std::array<Eigen::Index, 3> entries; ///< in a vector; -1: the component is not free
    Eigen::Vector3d force;               ///< N
    Eigen::Matrix3d tangent;             ///< N/mm
  };
  bool has_tools() const { return contact_.has_value(); }
  /// At the time of the step's equation.  @param clamp  leaves out the negative part of tangents
  std::vector<PressedNode> pressed_nodes(const Vector& at, Clamp clamp) const;
  /// Lumped mass M + damping C, without damping by stiffness.
  const Vector& diagonal() const { return diagonal_; }

  /// The springs' part alone: minus their forces, and their energy.
  virtual void spring_residual(const Vector& at, mechanics::Expect expect, Vector& residual) {
    springs_.residual(at, 0, expect, residual);
  }
  virtual double spring_energy(const Vector& at) { return springs_.energy(at, 0); }
  /// Norm of the forces that springs exert on supports, N; asked for where supports move.
  virtual double reaction(const Vector& at) = 0;

  /// Whether inertia joins nodes: consistent masses, damping by stiffness.
  virtual bool joins_nodes() const = 0;
  /// product += (mass M + damping C) motion without the lumped part, on free degrees of freedom.
  virtual void add_joined(double mass, double damping, const Vector& motion, Vector& product) = 0;

 private:
  mechanics::DisplacementAt displacements(const Vector& at) const;
  double size_of_press(const Vector& at) const; ///< N: norm of what tools do to nodes

  mechanics::NonlinearProblem& springs_;
  Entries entries_;
  std::optional<mechanics::StepTerms> terms_;
  StepMethod method_, fresh_method_; ///< the latter as it was before the first step
  Vector diagonal_;
  std::optional<Pull> pull_;
  double largest_pull_ = 0;   ///< N
  double largest_press_ = 0;  ///< N, of tools at the end of a step
  Vector seen_at_, seen_;     ///< where this step's residual was last asked for, and it; of a body with tools
  Vector unbalanced_;         ///< N, what the last step has left, of a body with tools
  std::optional<double> end_; ///< s, of that step; none: it is not known
  std::optional<mechanics::Contact> contact_;                ///< none: no tool presses the body
  std::vector<std::array<Eigen::Index, 3>> entries_of_node_; ///< beside it
  Vector moved_, product_, added_; ///< since the step's origin; and forces of that, N
};

} // namespace springproof::msm
