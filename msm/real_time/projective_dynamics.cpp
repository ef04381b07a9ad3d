#include "cases/case/error.hpp"
#include "msm/moving_springs.hpp"
#include "msm/real_time/step_method.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace springproof::msm {

namespace {

/// action(a, b, weight) for the pairs of a term's places: its part of the constant matrix is weight I. A
/// spring has its stiffness at rest, a volume term k_v of its mean deformation gradient F, whose distance
/// from the nearest one of the same volume grows by tr(F - I)/sqrt(3).
template<class Action>
void visit_weights(const Link& link, const Points&, const Action& action) {
  const double k = std::max(link.spring.stiffness, 0.);
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) action(a, b, a == b ? k : -k);
}
template<class Action>
void visit_weights(const Midline& midline, const Points&, const Action& action) {
  const double k = std::max(midline.spring.stiffness, 0.);
  for (std::size_t a = 0; a < 8; ++a)
    for (std::size_t b = 0; b < 8; ++b) action(a, b, k * midline.part(a) * midline.part(b));
}
template<class Volume, class Gradient, class Action>
void visit_volume(const Volume& volume, const Gradient& gradient, const Action& action) {
  const double k = 3 * std::max(volume.stiffness, 0.) / volume.rest_volume;
  for (std::size_t a = 0; a < gradient.size(); ++a)
    for (std::size_t b = 0; b < gradient.size(); ++b) action(a, b, k * gradient[a].dot(gradient[b]));
}
template<class Action>
void visit_weights(const VolumeCell& cell, const Points& rest, const Action& action) {
  visit_volume(cell, volume_gradient(at_nodes(cell.nodes, rest)), action);
}
template<class Action>
void visit_weights(const VolumePatch& patch, const Points& rest, const Action& action) {
  visit_volume(patch, patch.gradient(at_nodes(patch.nodes, rest)), action);
}
template<class Action>
void visit_weights(const Tetrahedron&, const Points&, const Action&) {} // refused below

/// Local and global steps, as one: u += (D + L)^-1 r, with the residual r of the whole equation. For Hooke's
/// springs the projections of Bouaziz et al. (2014) give the same; for other laws it is the quasi-Newton
/// method of Liu et al. (2017) without its line search.
class ProjectiveDynamics {
 public:
  ProjectiveDynamics(const Lattice& lattice, int iterations, std::optional<double> chebyshev)
      : lattice_(lattice), iterations_(iterations), radius_(chebyshev.value_or(0)) {
    if (!lattice.tetrahedra.empty())
      throw cases::InputError("msm.real_time.method: tetrahedra of biquadratic springs have no projection; "
                              "choose \"vertex_block_descent\" or \"implicit_euler\"");
  }

  /// Iterates, by Chebyshev's semi-iterative method: u' = omega (u + s - u_before) + u_before, s the plain
  /// step. Source: Wang (2015), algorithm 1, without its ten plain iterations at first: fewer leave less
  /// here.
  int operator()(const StepEquation& step, Points& at) {
    if (!is_factor_of(step)) factorise(step);
    if (step.pull) hold(*step.pull);
    step.go_freely(at);
    Vector right_side(n_free_), moved = Vector::Zero(n_free_); // by the iteration before
    double omega = 1;
    for (int n = 0; n < iterations_; ++n) {
      const Points residual = residual_of(step, lattice_, at);
      visit_free([&](std::size_t p, int c, int number) { right_side[number] = residual[p][c]; });
      if (n > 0) omega = 4 / (4 - radius_ * radius_ * (n == 1 ? 2 : omega));
      Vector plain = factor_->solve(right_side);
      if (step.pull) with_pull_.correct(*pull_, plain);
      moved = omega * plain + (omega - 1) * moved;
      visit_free([&](std::size_t p, int c, int number) { at[p][c] += moved[number]; });
    }
    return iterations_;
  }

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  const Lattice& lattice_;
  int iterations_, n_free_ = 0;
  double radius_;                                        ///< 0: no acceleration
  Points factorised_;                                    ///< the inertia of the factor
  std::vector<std::array<int, 3>> number_;               ///< each point's free components'; -1: constrained
  std::shared_ptr<Eigen::SimplicialLLT<Matrix>> factor_; ///< shared: a function can be copied
  std::optional<mechanics::PullOfPoints> held_;          ///< what with_pull_ is of
  std::optional<Pull> pull_;
  WithPull<double> with_pull_;

  template<class Action>
  void visit_free(const Action& action) const {
    for (std::size_t p = 0; p < number_.size(); ++p)
      for (int c = 0; c < 3; ++c)
        if (const int number = number_[p][cases::index(c)]; number >= 0) action(p, c, number);
  }

  /// Steps of equal length have lengths that differ by rounding.
  bool is_factor_of(const StepEquation& step) const {
    return std::equal(step.inertia.begin(), step.inertia.end(), factorised_.begin(), factorised_.end(),
                      [](const auto& now, const auto& then) { return now.isApprox(then, 1e-9); });
  }

  /// The pull is a part of the global step.
  void hold(const mechanics::PullOfPoints& pull) {
    if (pull.is_at_place_of(held_)) return;
    held_ = pull;
    Pull::Entries entries;
    for (const auto& [point, weight] : pull.weights)
      for (std::size_t c = 0; c < 3; ++c)
        if (const int at = number_[point][c]; at >= 0) entries[c].push_back({at, weight, true});
    pull_.emplace(std::move(entries), pull.stiffness);
    with_pull_.prepare(*pull_, n_free_, [&](const Vector& in, Vector& out) { out = factor_->solve(in); });
  }

  void factorise(const StepEquation& step) {
    factorised_ = step.inertia;
    held_.reset();
    number_.clear();
    n_free_ = 0;
    for (const Eigen::Vector3d& d : step.inertia) {
      std::array<int, 3> of_point;
      for (int c = 0; c < 3; ++c) of_point[cases::index(c)] = d[c] > 0 ? n_free_++ : -1;
      number_.push_back(of_point);
    }
    std::vector<Eigen::Triplet<double>> entries;
    visit_free(
        [&](std::size_t p, int c, int number) { entries.emplace_back(number, number, step.inertia[p][c]); });
    for_each_kind(lattice_, [&](const auto& terms) {
      for (const auto& term : terms) {
        const auto nodes = nodes_of(term);
        visit_weights(term, lattice_.rest, [&](std::size_t a, std::size_t b, double weight) {
          for (std::size_t c = 0; c < 3; ++c) {
            const int row = number_[cases::index(nodes[a])][c], column = number_[cases::index(nodes[b])][c];
            if (row >= 0 && column >= 0) entries.emplace_back(row, column, weight);
          }
        });
      }
    });
    Matrix matrix(n_free_, n_free_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factor_ = std::make_shared<Eigen::SimplicialLLT<Matrix>>(matrix);
  }
};

} // namespace

MakeStep make_projective_dynamics(const Lattice& lattice, int iterations, std::optional<double> chebyshev) {
  return ProjectiveDynamics(lattice, iterations, chebyshev);
}

} // namespace springproof::msm
