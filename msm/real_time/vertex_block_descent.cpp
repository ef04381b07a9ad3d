#include "msm/real_time/colours.hpp"
#include "msm/real_time/step_method.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace springproof::msm {

namespace {

template<class Term, class Places>
auto forces_of(const Term& term, const Places& x) {
  return term.forces(x);
}
Positions<2> forces_of(const Link& link, const Positions<2>& x) {
  const Eigen::Vector3d force = spring_force(x[1] - x[0], link.spring);
  return {force, -force};
}

/// Newton's step for one node after the other, the others held: H du = r, H = D + its block of the tangent
/// without negative parts. Nodes of a colour share no term.
/// Source: Chen et al. (2024), eq. 6 to 11, and their adaptive initialisation.
class VertexBlockDescent {
 public:
  VertexBlockDescent(const Lattice& lattice, int iterations, int n_threads)
      : lattice_(lattice), iterations_(iterations), n_threads_(n_threads), terms_(lattice.rest.size()),
        pulled_(lattice.rest.size()) {
    const auto nodes = nodes_of_terms(lattice);
    for (std::size_t term = 0; term < nodes.size(); ++term)
      for (const int node : nodes[term]) terms_[cases::index(node)].push_back(static_cast<int>(term));
    colours_ = mechanics::colour(terms_, nodes.size());
  }

  int operator()(const StepEquation& step, Points& at) {
    begin(step, at);
    std::fill(pulled_.begin(), pulled_.end(), 0.);
    if (step.pull)
      for (const auto& [node, weight] : step.pull->weights) pulled_[node] = weight;
    const auto move = [&](std::size_t node) {
      if ((step.inertia[node].array() > 0).any()) at[node] += newton_step(step, node, at);
    };
    for (int n = 0; n < iterations_; ++n) {
      mechanics::for_each_item(colours_, n_threads_, [&](std::size_t node) {
        if (pulled_[node] == 0) move(node);
      });
      if (step.pull) // joins its nodes: no two of them are of one colour
        for (const auto& [node, weight] : step.pull->weights) move(node);
    }
    return iterations_;
  }

 private:
  const Lattice& lattice_;
  int iterations_, n_threads_;
  std::vector<std::vector<int>> terms_; ///< those at each node
  mechanics::Colours colours_;
  std::vector<double> pulled_; ///< each node's weight in what pulls
  Points last_, last_moved_;   ///< mm: where the step before began, and by how much it moved; empty: none yet

  /// Starts with the velocity, and with as much of the outer forces as have accelerated the body before:
  /// supports that carry them leave none, and a body at rest stays where it is.
  void begin(const StepEquation& step, Points& at) {
    if (last_.empty()) last_ = step.origin;
    last_moved_.resize(at.size(), Eigen::Vector3d::Zero());
    for (std::size_t p = 0; p < at.size(); ++p) {
      const Eigen::Vector3d moved = step.origin[p] - last_[p],
                            outer = step.moved_by(p, step.force[p]) - moved;
      const double part = (moved - last_moved_[p]).dot(outer) / outer.squaredNorm();
      const Eigen::Vector3d guess = step.origin[p] + moved + (part > 0 ? std::min(part, 1.) : 0.) * outer;
      at[p] = (step.inertia[p].array() > 0).select(guess, at[p]);
      last_moved_[p] = moved;
    }
    last_ = step.origin;
  }

  Eigen::Vector3d newton_step(const StepEquation& step, std::size_t node, const Points& at) const {
    Eigen::Vector3d residual = step.rest_of(node, at[node]);
    Eigen::Matrix3d stiffness = step.inertia[node].asDiagonal();
    if (pulled_[node] > 0) {
      residual += pulled_[node] * step.pull->force(at);
      // Not weight² times: a node alone would go the whole way of the mean. With weights of sum 1 this bounds
      // the pull's tangent, k w w^T.
      stiffness.diagonal().array() += step.pull->stiffness * pulled_[node];
    }
    for (const int number : terms_[node])
      with_term(lattice_, cases::index(number), [&](const auto& term) {
        const auto nodes = nodes_of(term);
        auto x = at_nodes(nodes, at);
        std::size_t own = 0;
        for (std::size_t a = 0; a < nodes.size(); ++a) {
          x[a] += lattice_.rest[cases::index(nodes[a])];
          if (cases::index(nodes[a]) == node) own = a;
        }
        residual += forces_of(term, x)[own];
        stiffness += term.tangent(x, Clamp::yes)(own, own);
      });
    for (int c = 0; c < 3; ++c)
      if (!(step.inertia[node][c] > 0)) {
        residual[c] = 0;
        stiffness.row(c).setZero();
        stiffness.col(c).setZero();
        stiffness(c, c) = 1;
      }
    return stiffness.ldlt().solve(residual);
  }
};

} // namespace

MakeStep make_vertex_block_descent(const Lattice& lattice, int iterations, int n_threads) {
  return VertexBlockDescent(lattice, iterations, n_threads);
}

} // namespace springproof::msm
