#include "msm/direct/patched_system.hpp"

#include "mechanics/grid/krylov.hpp"
#include "mechanics/grid/lowest_mode.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/tangent.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

namespace springproof::msm {

namespace {

using cases::index;
using mechanics::Convexity;
using mechanics::grid::LinearSolution;

/// The tangent of volume terms at nodes, times a motion: the sum of
///   k/V0 law'' (dV . motion) dV  over the terms, and unless clamped of
///   p d(dV)/dx . motion          over the tetrahedra, p a quarter of the pressures of their nodes' terms.
class PatchProduct {
 public:
  explicit PatchProduct(const std::vector<VolumePatch>& patches) : patches_(patches) {
    std::vector<std::pair<std::array<int, 4>, std::size_t>> all; // its nodes, and where it was met
    for (const VolumePatch& patch : patches)
      for (const std::array<int, 4>& places : patch.tetrahedra) {
        std::array<int, 4> nodes{};
        for (std::size_t v = 0; v < 4; ++v) nodes[v] = patch.nodes[index(places[v])];
        all.emplace_back(nodes, all.size());
      }
    std::sort(all.begin(), all.end());
    of_patch_.resize(all.size());
    for (const auto& [nodes, met] : all) {
      if (tetrahedra_.empty() || tetrahedra_.back() != nodes) tetrahedra_.push_back(nodes);
      of_patch_[met] = tetrahedra_.size() - 1;
    }
  }

  void linearise(const Points& positions, Clamp clamp) {
    positions_ = positions;
    slopes_.clear();
    gradients_.clear();
    pressures_.assign(tetrahedra_.size(), 0);
    bool has_pressure = false;
    auto tetrahedron = of_patch_.begin();
    for (const VolumePatch& patch : patches_) {
      const Points own = at_nodes(patch.nodes, positions), gradient = patch.gradient(own);
      const VolumeLaw law = patch.law(own);
      slopes_.push_back(patch.stiffness / patch.rest_volume * law.slope);
      gradients_.insert(gradients_.end(), gradient.begin(), gradient.end());
      has_pressure = has_pressure || law.pressure != 0;
      for (std::size_t n = 0; n < patch.tetrahedra.size(); ++n)
        pressures_[*tetrahedron++] += patch.stiffness * law.pressure / 4;
    }
    if (clamp == Clamp::yes || !has_pressure) pressures_.clear();
  }

  void add(const Points& motion, Points& to) const {
    auto gradient = gradients_.begin();
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      const auto first = gradient;
      double change = 0;
      for (const int node : patches_[p].nodes) change += gradient++->dot(motion[index(node)]);
      gradient = first;
      for (const int node : patches_[p].nodes) to[index(node)] += slopes_[p] * change * *gradient++;
    }
    for (std::size_t t = 0; t < pressures_.size(); ++t) {
      const Positions<4> at = at_nodes(tetrahedra_[t], positions_), by = at_nodes(tetrahedra_[t], motion);
      Positions<4> there, back;
      for (std::size_t v = 0; v < 4; ++v) there[v] = at[v] + by[v], back[v] = at[v] - by[v];
      there = volume_gradient(there); // a quadratic form, so that half of the difference is the derivative
      back = volume_gradient(back);
      for (std::size_t v = 0; v < 4; ++v)
        to[index(tetrahedra_[t][v])] += pressures_[t] / 2 * (there[v] - back[v]);
    }
  }

 private:
  const std::vector<VolumePatch>& patches_;
  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<std::size_t> of_patch_; ///< places in tetrahedra_, patch by patch
  Points positions_, gradients_;      ///< gradients patch by patch, in the order of its nodes
  std::vector<double> slopes_, pressures_;
};

Problem without_patches(const Problem& problem) {
  Problem springs{problem.mesh, {}, problem.force, problem.is_constrained, problem.supports};
  springs.lattice = {problem.lattice.rest,       problem.lattice.links,   problem.lattice.volume_cells, {},
                     problem.lattice.tetrahedra, problem.lattice.midlines};
  return springs;
}

class PatchedSystem : public SpringSystem {
 public:
  explicit PatchedSystem(const Problem& problem)
      : problem_(problem), springs_problem_(without_patches(problem)),
        tangent_(springs_problem_.lattice, problem.is_constrained), patches_(problem.lattice.volume_patches),
        whole_(make_direct_system(problem)), springs_(make_direct_system(springs_problem_)),
        factorised_at_(Vector::Zero(whole_->load().size())) {}

  const Vector& load() const override { return whole_->load(); }
  void residual(const Vector& displacement, double load_factor, mechanics::Expect expect,
                Vector& residual) override {
    whole_->residual(displacement, load_factor, expect, residual);
  }
  double energy(const Vector& displacement, double load_factor) override {
    return whole_->energy(displacement, load_factor);
  }
  double reaction(const Vector& displacement) override { return whole_->reaction(displacement); }
  std::string cause_of_instability() const override { return whole_->cause_of_instability(); }
  std::size_t n_unknowns() const override { return whole_->n_unknowns(); }
  int n_inverted(const Vector& displacement) override { return whole_->n_inverted(displacement); }
  bool moves_supports() const override { return whole_->moves_supports(); }
  void move_supports(Vector& displacement, double load_factor) const override {
    whole_->move_supports(displacement, load_factor);
  }
  Work work() const override {
    Work all = whole_->work();
    all.linear_iterations = work_.linear_iterations;
    all.factorisations += springs_->work().factorisations;
    return all;
  }

  /// Volume terms of no negative stiffness only add to what sound springs resist. Where springs alone are not
  /// sound, the whole tangent tells.
  mechanics::RestState rest_state() override {
    const bool is_sound = springs_->rest_state() == mechanics::RestState::sound;
    return is_sound ? mechanics::RestState::sound : whole_->rest_state();
  }

  std::optional<bool> is_stable(const Vector& displacement) override {
    if (!has_factor()) return whole_->is_stable(displacement);
    linearise(displacement, Clamp::no);
    const LinearSolution found = conjugate_gradients(random_force(), probe_target, 0);
    if (found.converged || found.met_negative_curvature) return found.converged;
    const auto mode = lowest_mode(displacement);
    return mode ? std::optional(mode->eigenvalue > 0) : std::nullopt;
  }

  std::optional<Mode> lowest_mode(const Vector& displacement) override {
    if (!has_factor()) return whole_->lowest_mode(displacement);
    linearise(displacement, Clamp::no);
    return mechanics::grid::lowest_mode({[&](const Vector& in, Vector& out) { product(in, 0, out); },
                                         [&](const Vector& in, Vector& out) { precondition(in, out); },
                                         [](const Vector& a, const Vector& b) { return a.dot(b); }, 1, 1e-8},
                                        random_force());
  }

 private:
  /// Iterations after which the springs are factorised anew where the body has come to, and the most.
  static constexpr int many_iterations = 60, most_iterations = 400;
  static constexpr double probe_target = 1e-3; ///< residual of a random force, as on grids

  const Problem& problem_;
  Problem springs_problem_;
  Tangent tangent_; ///< the springs'
  PatchProduct patches_;
  std::unique_ptr<SpringSystem> whole_, springs_;
  Vector factorised_at_; ///< where the springs of the preconditioner are
  Convexity factorised_as_ = Convexity::exact;
  std::optional<std::pair<Vector, Clamp>> linearised_;
  const Tangent::Matrix* matrix_ = nullptr;
  std::optional<bool> has_factor_;

  /// Whether the springs at rest are positive definite without the volume terms.
  bool has_factor() {
    if (!has_factor_) has_factor_ = springs_->is_stable(factorised_at_);
    return *has_factor_;
  }

  void linearise(const Vector& displacement, Clamp clamp) {
    if (linearised_ == std::pair(displacement, clamp)) return;
    Points positions = to_points(problem_, displacement);
    for (std::size_t p = 0; p < positions.size(); ++p) positions[p] += problem_.lattice.rest[p];
    matrix_ = &tangent_.assemble(positions, clamp);
    patches_.linearise(positions, clamp);
    linearised_.emplace(displacement, clamp);
  }

  /// (tangent + shift) motion, 0 on supports.
  void product(const Vector& motion, double shift, Vector& image) const {
    Points of_patches(problem_.lattice.rest.size(), Eigen::Vector3d::Zero());
    patches_.add(to_points(problem_, motion), of_patches);
    image = to_vector(problem_, of_patches) + shift * motion;
    const Eigen::Index n = tangent_.n_free();
    image.head(n) += matrix_->selfadjointView<Eigen::Lower>() * motion.head(n);
    image.tail(image.size() - n).setZero();
  }

  void precondition(const Vector& force, Vector& motion) {
    if (!springs_->direction(factorised_at_, force, 0, 0, factorised_as_, motion)) motion = force;
  }

  Vector random_force() const {
    std::mt19937 generator(3);
    std::normal_distribution<double> normal;
    Vector force = Vector::Zero(load().size());
    for (double& entry : force.head(tangent_.n_free())) entry = normal(generator);
    return force;
  }

  LinearSolution conjugate_gradients(const Vector& force, double forcing, double shift,
                                     int iterations = most_iterations) {
    LinearSolution found = mechanics::grid::conjugate_gradients(
        [&](const Vector& in, Vector& out) { product(in, shift, out); },
        [&](const Vector& in, Vector& out) { precondition(in, out); }, force, forcing * force.norm(),
        iterations, [](const Vector& a, const Vector& b) { return a.dot(b); }, 1);
    work_.linear_iterations += found.iterations;
    return found;
  }

  bool solve(const Vector& displacement, const Vector& residual, double forcing, Clamp clamp, double shift,
             Vector& step) override {
    const auto factorise_whole = [&] {
      return whole_->direction(displacement, residual, 1, forcing,
                               clamp == Clamp::yes ? Convexity::clamped
                               : shift > 0         ? Convexity::shifted
                                                   : Convexity::exact,
                               step);
    };
    if (!has_factor()) return factorise_whole();
    linearise(displacement, clamp);
    LinearSolution found = conjugate_gradients(residual, forcing, shift, many_iterations);
    if (!found.converged && !found.met_negative_curvature) {
      factorised_at_ = displacement;
      factorised_as_ = Convexity::clamped;
      found = conjugate_gradients(residual, forcing, shift);
    }
    if (!found.converged && !found.met_negative_curvature) return factorise_whole();
    step.swap(found.solution);
    return found.converged && step.allFinite() && step.dot(residual) > 0;
  }
};

} // namespace

bool takes_patched_system(const Lattice& lattice) {
  const auto is_positive = [](const auto& terms, const auto& stiffness) {
    return std::all_of(terms.begin(), terms.end(), [&](const auto& term) { return stiffness(term) >= 0; });
  };
  return !lattice.volume_patches.empty() &&
         is_positive(lattice.volume_patches, [](const VolumePatch& patch) { return patch.stiffness; }) &&
         is_positive(lattice.links, [](const Link& link) { return link.spring.stiffness; });
}

std::unique_ptr<SpringSystem> make_patched_system(const Problem& problem) {
  return std::make_unique<PatchedSystem>(problem);
}

} // namespace springproof::msm
