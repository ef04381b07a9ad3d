#include "msm/grid/grid_system.hpp"

#include "cases/case/error.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "msm/grid/conjugate_gradients.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace springproof::msm::grid {

namespace {

using FieldD = Field<double>;

CellSprings cell_springs(const CellStiffness& k) {
  return {{k.edge, k.edge, k.edge},
          {k.face_diagonal, k.face_diagonal, k.face_diagonal},
          k.internal_diagonal,
          k.volume};
}

/// Calls action(number of the mesh's node, i, j, k) for the nodes of a grid, in the order of make_grid_mesh.
template<class Action>
void for_each_node(const Problem& problem, const Action& action) {
  const cases::Grid& grid = *problem.mesh.grid;
  for (std::size_t n = 0; n < problem.mesh.nodes.size(); ++n) {
    const Eigen::Vector3d at = (problem.mesh.nodes[n] - grid.origin).cwiseQuotient(grid.spacing);
    action(n, static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())),
           static_cast<int>(std::lround(at.z())));
  }
}

using mechanics::Convexity;

class GridSystem : public SpringSystem {
 public:
  GridSystem(const GridProblem& problem, int n_threads)
      : problem_(problem), n_threads_(n_threads), springs_(problem.body, n_threads),
        bodies_(coarsenings(problem.body)) {
    multigrid_.emplace(bodies_, n_threads);
  }

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

  std::optional<Vector> direction(const Vector& displacement, const Vector& residual, double, double forcing,
                                  Convexity convexity) override {
    const Clamp clamp = convexity == Convexity::clamped ? Clamp::yes : Clamp::no;
    const double shift =
        convexity == Convexity::shifted ? 2 * std::abs(lowest_mode(displacement)->eigenvalue) : 0;
    return solve(displacement, residual, forcing, clamp, shift);
  }

  std::optional<bool> is_stable(const Vector& displacement) override {
    if (displacement.isZero(0)) return true; // a sum of squares
    return lowest_mode(displacement)->eigenvalue > 0;
  }

  /// The tangent at rest has no negative eigenvalue; that it has no zero one shows
  /// in conjugate gradients reaching every part of a random right side, and by a motion that it resists:
  /// where rounding alone resists, the answer is a huge motion, whose Rayleigh quotient tells.
  mechanics::RestState rest_state() override {
    using mechanics::RestState;
    const Vector rest = Vector::Zero(problem_.load.size());
    const auto motion = solve(rest, probe(), 1e-6, Clamp::no);
    if (!motion) return RestState::mechanism;
    Vector image = rest;
    springs_.product(Clamp::no, rest, probe(), image);
    const double typical = probe().dot(image) / probe().squaredNorm();
    const double lowest = motion->dot(probe()) / motion->squaredNorm();
    // Rounding leaves 1e-16, the softest lattice seen 1e-8.
    return lowest > 1e-12 * typical ? RestState::sound : RestState::mechanism;
  }

  /// LOBPCG with one vector (Knyazev 2001): Rayleigh-Ritz on the vector, its preconditioned residual and the
  /// last step. Images under the tangent are combined like the vectors, so that each iteration needs one.
  std::optional<Mode> lowest_mode(const Vector& displacement) override {
    if (mode_at_.size() > 0 && mode_at_ == displacement) return mode_;
    linearise(displacement);
    const Eigen::Index size = problem_.load.size();
    using Columns = std::array<Vector, 3>; // the vector, its preconditioned residual, the last step
    Columns basis, image;
    for (std::size_t c = 0; c < 3; ++c) basis[c] = image[c] = Vector::Zero(size);
    const auto examine = [&](std::size_t c, const Vector& right_side) {
      multigrid_->apply(right_side, basis[c]);
      scale(basis[c], 1 / norm(basis[c]));
      springs_.product(Clamp::no, displacement, basis[c], image[c]);
    };
    examine(0, probe()); // rich in low modes
    double eigenvalue = grid::dot(basis[0], image[0], n_threads_);
    std::size_t n = 2;
    for (int iteration = 0; iteration < max_mode_iterations; ++iteration, n = 3) {
      Vector residual = image[0];
      add(residual, -eigenvalue, basis[0], n_threads_);
      examine(1, residual);
      const auto products = [&](const Columns& left, const Columns& right) {
        Eigen::MatrixXd all(n, n);
        for (std::size_t r = 0; r < n; ++r)
          for (std::size_t c = 0; c < n; ++c)
            all(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
                grid::dot(left[r], right[c], n_threads_);
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
      const double to_unit = 1 / norm(basis[0]), step_to_unit = 1 / norm(basis[2]);
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

  int n_inverted(const Vector& displacement) override {
    const Body& body = problem_.body;
    int n = 0;
#pragma omp parallel for num_threads(n_threads_) reduction(+ : n) if (n_threads_ > 1)
    for (int k = 0; k < body.cells[2]; ++k)
      for (int j = 0; j < body.cells[1]; ++j)
        for (int i = 0; i < body.cells[0]; ++i) {
          if (!body.is_uniform() && !has_springs(body.cell(i, j, k))) continue;
          std::array<Eigen::Vector3d, 8> vertices;
          for (int v = 0; v < 8; ++v) {
            const int x = i + (v & 1), y = j + ((v >> 1) & 1), z = k + (v >> 2);
            const std::ptrdiff_t at = body.layout.at(x, y, z);
            vertices[static_cast<std::size_t>(v)] =
                Eigen::Vector3d(x, y, z).cwiseProduct(body.spacing) +
                Eigen::Vector3d(displacement[at], displacement[at + body.layout.size],
                                displacement[at + 2 * body.layout.size]);
          }
          if (!(cases::smallest_corner_jacobian(vertices) > 0)) ++n;
        }
    return n;
  }

  bool moves_supports() const override {
    return bool(problem_.supports);
  }

  void move_supports(Vector& displacement, double load_factor) const override {
    if (!problem_.supports) return;
    const Vector there = problem_.supports(load_factor);
    for (const std::ptrdiff_t entry : problem_.body.constrained) displacement[entry] = there[entry];
  }

  double reaction(const Vector& displacement) override {
    if (!loose_springs_) {
      loose_body_ = problem_.body;
      loose_body_.constrained.clear();
      loose_springs_.emplace(loose_body_, n_threads_);
    }
    Vector force = Vector::Zero(displacement.size());
    loose_springs_->force(displacement, force);
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
  Body loose_body_; ///< the body with nothing held, for the forces on its supports
  std::optional<SpringField<double>> loose_springs_;
  Vector linearised_at_, probe_, mode_at_;
  Mode mode_{};

  double norm(const Vector& v) const {
    return std::sqrt(grid::dot(v, v, n_threads_));
  }
  void scale(Vector& v, double factor) const {
    for_each_piece(v.size(), n_threads_,
                   [&](std::ptrdiff_t first, std::ptrdiff_t n) { v.segment(first, n) *= factor; });
  }

  static bool has_springs(const CellSprings& cell) {
    return cell.edge[0] != 0 || cell.face_diagonal[0] != 0 || cell.internal_diagonal != 0 || cell.volume != 0;
  }

  void linearise(const Vector& displacement) {
    if (linearised_at_.size() > 0 && linearised_at_ == displacement) return;
    multigrid_->linearise(displacement);
    linearised_at_ = displacement;
  }

  /// (tangent + shift) x = right side, or nothing when some direction meets no or negative curvature.
  std::optional<Vector> solve(const Vector& displacement, const Vector& right_side, double forcing,
                              Clamp clamp, double shift = 0) {
    linearise(displacement);
    const auto apply = [&](const Vector& v, Vector& out) {
      springs_.product(clamp, displacement, v, out);
      if (shift != 0) add(out, shift, v, n_threads_);
    };
    const auto precondition = [&](const Vector& r, Vector& out) { multigrid_->apply(r, out); };
    // The cycle keeps what it learnt at the displacements before this one. After one where points coincide or
    // fly off that may be wrong, and then a new cycle has to start afresh.
    for (const bool may_be_misled : {true, false}) {
      const ConjugateGradients found =
          conjugate_gradients(apply, precondition, right_side, forcing, max_iterations, n_threads_);
      work_.linear_iterations += found.iterations;
      if (found.converged) return found.solution;
      if (found.met_negative_curvature || !may_be_misled) break;
      multigrid_.emplace(bodies_, n_threads_);
      linearised_at_.resize(0);
      linearise(displacement);
    }
    return std::nullopt;
  }

  /// A fixed right side with a part in every motion.
  const Vector& probe() {
    if (probe_.size() > 0) return probe_;
    probe_ = Vector::Zero(problem_.load.size());
    std::mt19937 generator(3);
    std::normal_distribution<double> normal;
    const Layout& layout = problem_.body.layout;
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < layout.nodes[2]; ++k)
        for (int j = 0; j < layout.nodes[1]; ++j)
          for (int i = 0; i < layout.nodes[0]; ++i)
            probe_[c * layout.size + layout.at(i, j, k)] = normal(generator);
    clear_constrained(problem_.body, probe_);
    return probe_;
  }
};

} // namespace

std::optional<GridProblem> make_grid_problem(const Problem& problem,
                                             const std::vector<CellStiffness>& stiffness) {
  if (!problem.mesh.grid) return std::nullopt;
  const cases::Grid& grid = *problem.mesh.grid;
  GridProblem result;
  Body& body = result.body;
  body.cells = grid.cells;
  body.spacing = grid.spacing;
  if (grid.present.empty() && stiffness.size() == 1) {
    body.springs = {cell_springs(stiffness.front())};
  } else {
    std::size_t next = 0;
    for (int k = 0; k < grid.cells[2]; ++k)
      for (int j = 0; j < grid.cells[1]; ++j)
        for (int i = 0; i < grid.cells[0]; ++i) {
          body.springs.emplace_back();
          if (!grid.has(i, j, k)) continue;
          body.springs.back() = cell_springs(stiffness[stiffness.size() == 1 ? 0 : next]);
          ++next;
        }
  }
  body.layout = make_layout(body.cells);
  std::vector<bool> is_constrained(static_cast<std::size_t>(3 * body.layout.size));
  for_each_node(problem, [&](std::size_t n, int i, int j, int k) {
    for (std::size_t c = 0; c < 3; ++c)
      if (problem.is_constrained[3 * n + c])
        is_constrained[c * static_cast<std::size_t>(body.layout.size) +
                       static_cast<std::size_t>(body.layout.at(i, j, k))] = true;
  });
  set_layout(body, [&](int i, int j, int k, int c) {
    return is_constrained[static_cast<std::size_t>(c * body.layout.size + body.layout.at(i, j, k))];
  });
  result.load = to_field(problem, body, problem.force);
  clear_constrained(body, result.load);
  if (problem.supports) {
    result.supports = [&problem, layout = body.layout](double load_factor) {
      Body shape; // to_field() wants the layout alone
      shape.layout = layout;
      return to_field(problem, shape, problem.supports(load_factor));
    };
  }
  return result;
}

std::unique_ptr<SpringSystem> make_grid_system(const GridProblem& problem, int n_threads) {
  return std::make_unique<GridSystem>(problem, n_threads);
}

std::optional<Vector> coarse_guess(const GridProblem& problem, int n_threads) {
  const std::array<bool, 3> axes = axes_to_coarsen(problem.body);
  if (!axes[0] && !axes[1] && !axes[2]) return std::nullopt;
  GridProblem coarse{coarsen(problem.body, axes), {}, {}};
  const Layout& layout = coarse.body.layout;
  if (layout.nodes[0] * layout.nodes[1] * layout.nodes[2] < 60) return std::nullopt;
  const Transfer<double> transfer(problem.body, coarse.body, axes, n_threads);
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

Points to_points(const Problem& problem, const Body& body, const Field<double>& field) {
  Points points(problem.mesh.nodes.size());
  for_each_node(problem, [&](std::size_t n, int i, int j, int k) {
    const std::ptrdiff_t at = body.layout.at(i, j, k);
    points[n] = {field[at], field[at + body.layout.size], field[at + 2 * body.layout.size]};
  });
  return points;
}

Field<double> to_field(const Problem& problem, const Body& body, const Points& points) {
  Field<double> field = Field<double>::Zero(3 * body.layout.size);
  for_each_node(problem, [&](std::size_t n, int i, int j, int k) {
    for (int c = 0; c < 3; ++c) field[c * body.layout.size + body.layout.at(i, j, k)] = points[n][c];
  });
  return field;
}

} // namespace springproof::msm::grid
