#include "msm/equilibrium.hpp"

#include "cases/error.hpp"

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

namespace msm {

using Vector = Eigen::VectorXd; ///< on the free degrees of freedom

namespace {

/// CHOLMOD with METIS' nested dissection, which on lattices of cells fills in a third of what minimum degree
/// does.
class Factorisation : public Eigen::CholmodSupernodalLLT<Tangent::Matrix, Eigen::Lower> {
 public:
  Factorisation() {
    cholmod().nmethods = 1;
    cholmod().method[0].ordering = CHOLMOD_METIS;
    cholmod().print = 0;
  }
};

} // namespace

struct EquilibriumSolver::Implementation {
  const Problem& problem;
  EquilibriumSettings settings;
  Tangent tangent;
  Factorisation factorisation;
  Vector load; ///< at full load, N
  double load_norm;
  Equilibrium state;

  Implementation(const Problem& p, const EquilibriumSettings& s)
      : problem(p), settings(s), tangent(p.lattice, p.is_fixed), load(on_free(p.force)) {
    factorisation.analyzePattern(tangent.assemble(p.lattice.rest, TransverseTerm::exact));
    double squared = 0;
    for (const Eigen::Vector3d& f : p.force) squared += f.squaredNorm();
    load_norm = std::sqrt(squared);
  }

  Vector on_free(const Points& points) const {
    Vector v(tangent.n_free());
    for (std::size_t d = 0; d < 3 * points.size(); ++d)
      if (const int free = tangent.free_number()[d]; free >= 0)
        v[free] = points[d / 3][static_cast<int>(d % 3)];
    return v;
  }

  Points moved(const Points& positions, const Vector& step, double factor) const {
    Points result = positions;
    for (std::size_t d = 0; d < 3 * positions.size(); ++d)
      if (const int free = tangent.free_number()[d]; free >= 0)
        result[d / 3][static_cast<int>(d % 3)] += factor * step[free];
    return result;
  }

  Vector imbalance(const Points& positions, double load_factor) const {
    return load_factor * load + on_free(internal_force(problem.lattice, positions));
  }

  double relative(const Vector& imbalance) const {
    return imbalance.norm() / (load_norm > 0 ? load_norm : 1.0);
  }

  /// Spring energy less the load's work from rest, N mm: what an equilibrium under dead load makes
  /// stationary.
  double potential(const Points& positions, double load_factor) const {
    double work = 0;
    for (std::size_t p = 0; p < positions.size(); ++p)
      work += problem.force[p].dot(positions[p] - problem.lattice.rest[p]);
    return energy(problem.lattice, positions) - load_factor * work;
  }

  /// Newton's direction from the exact tangent, or from the clamped one where the exact one is not positive
  /// definite.
  std::optional<Vector> direction(const Points& positions, const Vector& imbalance, TransverseTerm term) {
    factorisation.factorize(tangent.assemble(positions, term));
    ++state.factorisations;
    if (term == TransverseTerm::clamped) ++state.clamped_factorisations;
    if (factorisation.info() != Eigen::Success) return std::nullopt;
    Vector step = factorisation.solve(imbalance);
    if (!step.allFinite() || !(step.dot(imbalance) > 0)) return std::nullopt;
    return step;
  }

  /// Moves along the step as far as the potential falls enough (Armijo). Next to the solution the potential's
  /// change drowns in rounding: there a falling imbalance decides.
  bool line_search(Points& positions, const Vector& step, const Vector& before, double load_factor) const {
    const double start = potential(positions, load_factor);
    const double slope = step.dot(before);
    for (double factor = 1; factor > 1e-6; factor /= 2) {
      Points trial = moved(positions, step, factor);
      const double change = potential(trial, load_factor) - start;
      const bool in_rounding = factor * slope <= 1e-9 * (std::abs(start) + slope);
      if (change <= -1e-4 * factor * slope ||
          (in_rounding && imbalance(trial, load_factor).norm() < before.norm())) {
        positions = std::move(trial);
        return true;
      }
    }
    return false;
  }

  /// Newton at one load. On success positions is the equilibrium; otherwise it is of no use.
  bool newton(Points& positions, double load_factor) {
    for (int iteration = 0; iteration < settings.max_newton_per_step; ++iteration) {
      const Vector before = imbalance(positions, load_factor);
      if (!before.allFinite()) return false;
      if (relative(before) <= settings.tolerance) return true;
      ++state.newton_iterations;
      std::optional<Vector> step = direction(positions, before, TransverseTerm::exact);
      bool moves = step && line_search(positions, *step, before, load_factor);
      if (!moves) {
        step = direction(positions, before, TransverseTerm::clamped);
        moves = step && line_search(positions, *step, before, load_factor);
      }
      if (!moves) return false;
    }
    return relative(imbalance(positions, load_factor)) <= settings.tolerance;
  }

  Equilibrium solve(const Points& start) {
    state = Equilibrium{};
    Points positions = start, previous = start;
    double reached = 0, step = 1, previous_step = 0;
    for (int n = 0; reached < 1; ++n) {
      if (n == settings.max_load_steps || step < settings.smallest_load_step) give_up(positions, reached, n);
      const double target = std::min(1.0, reached + step);
      Points trial = previous_step > 0 ? extrapolated(previous, positions, (target - reached) / previous_step)
                                       : positions;
      const int iterations_before = state.newton_iterations;
      if (!newton(trial, target)) {
        step = (target - reached) / 2;
        continue;
      }
      previous = std::exchange(positions, std::move(trial));
      previous_step = target - reached;
      reached = target;
      if (state.newton_iterations - iterations_before <= 8) step *= 2; // an easy step
    }
    state.residual = relative(imbalance(positions, 1));
    state.load_reached = 1;
    state.positions = std::move(positions);
    return state;
  }

  static Points extrapolated(const Points& before, const Points& now, double ratio) {
    Points guess = now;
    for (std::size_t p = 0; p < now.size(); ++p) guess[p] += ratio * (now[p] - before[p]);
    return guess;
  }

  [[noreturn]] void give_up(const Points& positions, double reached, int n_steps) {
    const std::string reason = n_steps == settings.max_load_steps
                                   ? "the limit on load steps was reached"
                                   : "no equilibrium was found beyond this load";
    throw cases::SolveError("mass-spring equilibrium: " + reason, reached,
                            relative(imbalance(positions, reached)));
  }
};

EquilibriumSolver::EquilibriumSolver(const Problem& problem, const EquilibriumSettings& settings)
    : implementation_(std::make_unique<Implementation>(problem, settings)) {}

EquilibriumSolver::~EquilibriumSolver() = default;

Equilibrium EquilibriumSolver::solve(const Points& start) {
  return implementation_->solve(start);
}

int EquilibriumSolver::n_free() const {
  return implementation_->tangent.n_free();
}

} // namespace msm
