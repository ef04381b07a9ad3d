#include "msm/grid/grid_system.hpp"

#include "cases/case/error.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <Eigen/Eigenvalues>
#include <utility>

namespace springproof::msm::grid {

namespace {

using cases::index;

CellSprings cell_springs(const CellStiffness& k) {
  return {{k.edge, k.edge, k.edge},
          {k.face_diagonal, k.face_diagonal, k.face_diagonal},
          k.internal_diagonal,
          k.volume};
}

/// Calls action(number of the mesh's node, component, entry of a field).
template<class Action>
void for_each_entry(const Problem& problem, const Layout& layout, const Action& action) {
  const cases::Grid& grid = *problem.mesh.grid;
  for (std::size_t n = 0; n < problem.mesh.nodes.size(); ++n) {
    const Eigen::Vector3d at = (problem.mesh.nodes[n] - grid.origin).cwiseQuotient(grid.spacing);
    const auto place = [&](int axis) { return static_cast<int>(std::lround(at[axis])); };
    for (int c = 0; c < 3; ++c) action(n, c, layout.at(place(0), place(1), place(2), c));
  }
}

class GridSystem : public SpringSystem {
 public:
  GridSystem(const GridProblem& problem, int n_threads)
      : problem_(problem), n_threads_(n_threads), springs_(problem.body, n_threads),
        bodies_(coarsenings(problem.body)), multigrid_(std::in_place, bodies_, n_threads) {}

  const Vector& load() const override { return problem_.load; }

  Vector residual(const Vector& displacement, double load_factor, mechanics::Expect) override {
    ++work_.force_evaluations;
    Vector force = Vector::Zero(displacement.size());
    springs_.force(displacement, force);
    add(force, load_factor, problem_.load, n_threads_);
    return force;
  }

  double energy(const Vector& displacement, double load_factor) override {
    return springs_.energy(displacement) - load_factor * grid::dot(problem_.load, displacement, n_threads_);
  }

  std::optional<bool> is_stable(const Vector& displacement) override {
    if (displacement.isZero(0)) return true; // a sum of squares
    return lowest_mode(displacement)->eigenvalue > 0;
  }

  /// The tangent at rest has no negative eigenvalue; that it has no zero one shows in conjugate gradients
  /// reaching every part of a random right side, and by a motion that it resists: where rounding alone
  /// resists, the answer is a huge motion, whose Rayleigh quotient tells.
  mechanics::RestState rest_state() override {
    using mechanics::RestState;
    const Vector rest = Vector::Zero(problem_.load.size());
    const auto motion = solve(rest, probe(), 1e-6, TransverseTerm::exact, 0);
    if (!motion) return RestState::mechanism;
    Vector image = rest;
    springs_.product(Clamp::no, rest, probe(), image);
    const double typical = probe_.dot(image) / probe_.squaredNorm();
    const double lowest = motion->dot(probe_) / motion->squaredNorm();
    // Rounding leaves 1e-16, the softest lattice seen 1e-8.
    return lowest > 1e-12 * typical ? RestState::sound : RestState::mechanism;
  }

  /// LOBPCG with one vector (Knyazev 2001): Rayleigh-Ritz on the vector, its preconditioned residual and the
  /// last step. Images under the tangent are combined like the vectors, so that each iteration needs one.
  std::optional<Mode> lowest_mode(const Vector& displacement) override {
    if (mode_at_.size() > 0 && mode_at_ == displacement) return mode_;
    multigrid_->linearise(displacement);
    const Eigen::Index size = problem_.load.size();
    using Columns = std::array<Vector, 3>; // the vector, its preconditioned residual, the last step
    Columns basis, image;
    for (std::size_t c = 0; c < 3; ++c) basis[c] = image[c] = Vector::Zero(size);
    const auto examine = [&](std::size_t c, const Vector& right_side) {
      multigrid_->apply(right_side, basis[c]);
      scale(basis[c], 1 / norm(basis[c], n_threads_));
      springs_.product(Clamp::no, displacement, basis[c], image[c]);
    };
    examine(0, probe()); // rich in low modes
    double eigenvalue = grid::dot(basis[0], image[0], n_threads_);
    int n = 2;
    for (int iteration = 0; iteration < max_mode_iterations; ++iteration, n = 3) {
      Vector residual = image[0];
      add(residual, -eigenvalue, basis[0], n_threads_);
      examine(1, residual);
      const auto products = [&](const Columns& left, const Columns& right) {
        Eigen::MatrixXd all(n, n);
        for (int r = 0; r < n; ++r)
          for (int c = 0; c < n; ++c) all(r, c) = grid::dot(left[index(r)], right[index(c)], n_threads_);
        return all;
      };
      const Eigen::MatrixXd gram = products(basis, basis), small = products(basis, image);
      const Eigen::LLT<Eigen::MatrixXd> factor(gram);
      if (factor.info() != Eigen::Success || !(factor.matrixL().toDenseMatrix().diagonal().minCoeff() > 1e-7))
        break; // nothing new in the residual
      const Eigen::MatrixXd left = factor.matrixL().solve(0.5 * (small + small.transpose()));
      const Eigen::MatrixXd reduced = factor.matrixL().solve(left.transpose());
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(reduced);
      const Eigen::VectorXd weights = factor.matrixU().solve(ritz.eigenvectors().col(0));
      const double before = std::exchange(eigenvalue, ritz.eigenvalues()[0]);
      for (Columns* columns : {&basis, &image}) {
        auto& [now, residual_part, step] = *columns;
        scale(step, n == 3 ? weights[2] : 0);
        add(step, weights[1], residual_part, n_threads_);
        scale(now, weights[0]);
        add(now, 1.0, step, n_threads_);
      }
      const double to_unit = 1 / norm(basis[0], n_threads_), step_to_unit = 1 / norm(basis[2], n_threads_);
      for (Columns* columns : {&basis, &image}) {
        scale((*columns)[0], to_unit);
        scale((*columns)[2], step_to_unit);
      }
      if (iteration > 2 && before - eigenvalue <= 1e-4 * std::abs(eigenvalue)) break;
    }
    mode_ = Mode{eigenvalue, basis[0]};
    mode_at_ = displacement;
    return mode_;
  }

  bool moves_supports() const override { return bool(problem_.supports); }

  int n_inverted(const Vector& displacement) override {
    const Body& body = problem_.body;
    int n = 0;
#pragma omp parallel for num_threads(n_threads_) reduction(+ : n) if (n_threads_ > 1)
    for (int k = 0; k < body.cells[2]; ++k)
      for (int j = 0; j < body.cells[1]; ++j)
        for (int i = 0; i < body.cells[0]; ++i) {
          if (!body.is_uniform() && body.cell(i, j, k).is_empty()) continue;
          CellPositions vertices;
          for (int v = 0; v < 8; ++v) {
            const int node[3] = {i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2)};
            for (int a = 0; a < 3; ++a)
              vertices[index(v)][a] =
                  node[a] * body.spacing[a] + displacement[body.layout.at(node[0], node[1], node[2], a)];
          }
          if (!(cases::smallest_corner_jacobian(vertices) > 0)) ++n;
        }
    return n;
  }

  void move_supports(Vector& displacement, double load_factor) const override {
    if (!problem_.supports) return;
    const Vector there = problem_.supports(load_factor);
    for (const std::ptrdiff_t entry : problem_.body.constrained) displacement[entry] = there[entry];
  }

  double reaction(const Vector& displacement) override {
    Vector force = Vector::Zero(displacement.size());
    springs_.reactions(displacement, force);
    double squared = 0;
    for (const std::ptrdiff_t entry : problem_.body.constrained) squared += force[entry] * force[entry];
    return std::sqrt(squared);
  }

 private:
  static constexpr int max_iterations = 300; ///< healthy lattices take less than 30
  static constexpr int max_mode_iterations = 100;

  const GridProblem& problem_;
  int n_threads_;
  SpringField<double> springs_;
  std::deque<Body> bodies_;
  std::optional<Multigrid> multigrid_;
  Vector probe_, mode_at_;
  Mode mode_{};

  /// A fixed right side with a part in every motion.
  const Vector& probe() {
    if (probe_.size() == 0)
      probe_ = random_field<double>(problem_.body, 3, std::normal_distribution<double>());
    return probe_;
  }

  void scale(Vector& v, double factor) const {
    for_each_piece(v.size(), n_threads_,
                   [&](std::ptrdiff_t first, std::ptrdiff_t n) { v.segment(first, n) *= factor; });
  }

  std::optional<Vector> solve(const Vector& displacement, const Vector& right_side, double forcing,
                              TransverseTerm term, double shift) override {
    const Clamp clamp = term == TransverseTerm::clamped ? Clamp::yes : Clamp::no;
    const auto apply = [&](const Vector& v, Vector& out) {
      springs_.product(clamp, displacement, v, out);
      if (shift != 0) add(out, shift, v, n_threads_);
    };
    // The cycle keeps what it learnt at the displacements before this one. After one where points coincide or
    // fly off that may be wrong, and then a new cycle has to start afresh.
    for (const bool may_be_misled : {true, false}) {
      multigrid_->linearise(displacement);
      const ConjugateGradients found = conjugate_gradients(apply, right_side, forcing);
      if (found.converged) return found.solution;
      if (found.met_negative_curvature || !may_be_misled) break;
      multigrid_.emplace(bodies_, n_threads_);
    }
    return std::nullopt;
  }

  struct ConjugateGradients {
    Vector solution;
    bool converged = false;
    bool met_negative_curvature = false; ///< of the operator, or none; then it did not converge
  };

  /// Conjugate gradients with the multigrid cycle, until the residual is at most `forcing` of the right side.
  /// The cycle is symmetric but for the rounding of single precision; Polak and Ribiere's formula does not
  /// mind.
  template<class Operator>
  ConjugateGradients conjugate_gradients(const Operator& apply, const Vector& right_side, double forcing) {
    const auto product_of = [&](const Vector& a, const Vector& b) { return grid::dot(a, b, n_threads_); };
    ConjugateGradients result;
    result.solution.setZero(right_side.size());
    Vector residual = right_side, preconditioned(right_side.size()), product = result.solution;
    multigrid_->apply(residual, preconditioned);
    Vector direction = preconditioned;
    double slope = product_of(residual, preconditioned);
    const double target = forcing * norm(right_side, n_threads_);
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      apply(direction, product);
      ++work_.linear_iterations;
      const double curvature = product_of(direction, product);
      result.met_negative_curvature = curvature <= 0;
      if (!(curvature > 0) || !(slope > 0)) return result;
      const double length = slope / curvature;
      add(result.solution, length, direction, n_threads_);
      add(residual, -length, product, n_threads_);
      result.converged = norm(residual, n_threads_) <= target;
      if (result.converged) return result;
      const double crossed = product_of(residual, preconditioned);
      multigrid_->apply(residual, preconditioned);
      const double now = product_of(residual, preconditioned), keep = (now - crossed) / slope;
      slope = now;
      for_each_piece(direction.size(), n_threads_, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
        direction.segment(first, n) = preconditioned.segment(first, n) + keep * direction.segment(first, n);
      });
    }
    return result;
  }
};

} // namespace

GridProblem make_grid_problem(const Problem& problem, const std::vector<CellStiffness>& stiffness) {
  const cases::Grid& grid = *problem.mesh.grid;
  GridProblem result;
  Body& body = result.body;
  body.cells = grid.cells;
  body.spacing = grid.spacing;
  if (grid.present.empty() && stiffness.size() == 1) {
    body.springs = {cell_springs(stiffness.front())};
  } else {
    std::size_t next = 0;
    for_each_place(grid.cells, [&](int i, int j, int k) {
      body.springs.emplace_back();
      if (!grid.has(i, j, k)) return;
      body.springs.back() = cell_springs(stiffness[stiffness.size() == 1 ? 0 : next++]);
    });
  }
  const Layout layout = make_layout(body.cells);
  std::vector<bool> is_constrained(index(3 * layout.size));
  for_each_entry(problem, layout, [&](std::size_t n, int c, std::ptrdiff_t entry) {
    is_constrained[index(entry)] = problem.is_constrained[3 * n + index(c)];
  });
  set_layout(body, [&](int i, int j, int k, int c) { return is_constrained[index(layout.at(i, j, k, c))]; });
  result.load = to_field(problem, layout, problem.force);
  clear_constrained(body, result.load);
  if (problem.supports)
    result.supports = [&problem, layout](double load_factor) {
      return to_field(problem, layout, problem.supports(load_factor));
    };
  return result;
}

std::unique_ptr<SpringSystem> make_grid_system(const GridProblem& problem, int n_threads) {
  return std::make_unique<GridSystem>(problem, n_threads);
}

std::optional<Vector> coarse_guess(const GridProblem& problem, int n_threads) {
  const std::optional<Body> body = coarsen(problem.body);
  if (!body) return std::nullopt;
  GridProblem coarse{*body, {}, {}};
  const Layout& layout = coarse.body.layout;
  if (layout.nodes[0] * layout.nodes[1] * layout.nodes[2] < 60) return std::nullopt;
  const Transfer<double> transfer(problem.body, coarse.body, n_threads);
  coarse.load.setZero(3 * layout.size);
  transfer.restrict(problem.load, coarse.load);
  const auto system = make_grid_system(coarse, n_threads);
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-3; // a guess
  settings.smallest_load_step = 0.25;
  settings.max_convexified_per_step = 0; // nor may it leave the path from rest
  settings.stability = mechanics::Stability::ignore;
  settings.guess = coarse_guess(coarse, n_threads);
  try {
    const Vector rest = Vector::Zero(coarse.load.size());
    Vector guess = Vector::Zero(problem.load.size());
    transfer.prolong(mechanics::find_equilibrium(*system, rest, "coarse lattice", settings).state, guess);
    return guess;
  } catch (const cases::SolveError&) {
    return std::nullopt; // the fine lattice has to find its own way
  }
}

Points to_points(const Problem& problem, const Layout& layout, const Field<double>& field) {
  Points points(problem.mesh.nodes.size());
  for_each_entry(problem, layout,
                 [&](std::size_t n, int c, std::ptrdiff_t entry) { points[n][c] = field[entry]; });
  return points;
}

Field<double> to_field(const Problem& problem, const Layout& layout, const Points& points) {
  Field<double> field = Field<double>::Zero(3 * layout.size);
  for_each_entry(problem, layout,
                 [&](std::size_t n, int c, std::ptrdiff_t entry) { field[entry] = points[n][c]; });
  return field;
}

} // namespace springproof::msm::grid
