#include "msm/grid/grid_system.hpp"

#include "cases/mesh/sharing.hpp"
#include "mechanics/grid/coarse_guess.hpp"
#include "mechanics/grid/krylov.hpp"
#include "mechanics/grid/lowest_mode.hpp"
#include "msm/grid/transfer.hpp"

#include <cmath>
#include <optional>
#include <utility>

namespace springproof::msm::grid {

namespace {

using cases::index;
using mechanics::grid::LinearSolution;

CellSprings cell_springs(const CellStiffness& k) {
  return {{k.edge, k.edge, k.edge},
          {k.face_diagonal, k.face_diagonal, k.face_diagonal},
          k.internal_diagonal,
          k.volume,
          {k.midline, k.midline, k.midline}};
}

/// Returns the place here of a node of the mesh, if it is here.
std::optional<std::array<int, 3>> place_of(const Problem& problem, const Body& body, std::size_t node) {
  const cases::Grid& grid = *problem.mesh.grid;
  const std::array<int, 3> first = body.part ? body.part->first : std::array<int, 3>{0, 0, 0};
  const Eigen::Vector3d at = (problem.mesh.nodes[node] - grid.origin).cwiseQuotient(grid.spacing);
  std::array<int, 3> place;
  for (std::size_t a = 0; a < 3; ++a) {
    place[a] = static_cast<int>(std::lround(at[static_cast<int>(a)])) - first[a];
    if (place[a] < 0 || place[a] >= body.layout.nodes[a]) return std::nullopt;
  }
  return place;
}

/// Calls action(number of the mesh's node, its place here) for the nodes that are here.
template<class Action>
void for_each_node(const Problem& problem, const Body& body, const Action& action) {
  if (const auto& whole = problem.mesh.nodes.rule) { // its nodes are numbered by their places
    const std::array<int, 3> first = body.part ? body.part->first : std::array<int, 3>{0, 0, 0};
    return for_each_place(body.layout.nodes, [&](int i, int j, int k) {
      const std::size_t row = index(first[1] + j) + index(whole->cells[1] + 1) * index(first[2] + k);
      action(index(first[0] + i) + index(whole->cells[0] + 1) * row, std::array<int, 3>{i, j, k});
    });
  }
  for (std::size_t n = 0; n < problem.mesh.nodes.size(); ++n)
    if (const auto place = place_of(problem, body, n)) action(n, *place);
}

/// Makes a field of some nodes' vectors, 0 on the others.
Field<double> to_field(const Problem& problem, const Body& body, const std::vector<cases::NodeVector>& some) {
  Field<double> field = Field<double>::Zero(3 * body.layout.size);
  for (const auto& [node, value] : some)
    if (const auto at = place_of(problem, body, index(node)))
      for (int c = 0; c < 3; ++c) field[body.layout.at((*at)[0], (*at)[1], (*at)[2], c)] = value[c];
  return field;
}

class MatrixFreeSystem : public GridSystem {
 public:
  MatrixFreeSystem(const GridProblem& problem, int n_threads)
      : problem_(problem), n_threads_(n_threads), springs_(problem.body, n_threads) {}

  const SpringField<double>& springs() const override { return springs_; }
  const Vector& load() const override { return problem_.load; }

  void residual(const Vector& displacement, double load_factor, mechanics::Expect, Vector& force) override {
    ++work_.force_evaluations;
    if (force.size() != displacement.size()) force.setZero(displacement.size()); // ghosts stay 0
    if (any_rank(!is_small(problem_.body, displacement))) {
      springs_.force(displacement, force);
    } else { // the midpoint rule of internal_force_at()
      middle_ = 0.5 * displacement;
      backwards_ = -displacement;
      springs_.product(Clamp::no, middle_, backwards_, force);
    }
    if (load_factor != 0) add(force, load_factor, problem_.load, n_threads_);
  }

  double energy(const Vector& displacement, double load_factor) override {
    return springs_.energy(displacement) - load_factor * dot(problem_.load, displacement);
  }

  double dot(const Vector& left, const Vector& right) const override {
    return grid::dot(problem_.body, left, right, n_threads_);
  }
  double largest(const Vector& of) const override {
    return problem_.body.part ? problem_.body.part->ranks->largest(of.cwiseAbs().maxCoeff())
                              : SpringSystem::largest(of);
  }
  bool any_rank(bool here) const override { return !on_all_ranks(problem_.body, !here); }

  std::optional<bool> is_stable(const Vector& displacement) override {
    if (on_all_ranks(problem_.body, displacement.isZero(0))) return true; // a sum of squares
    const LinearSolution found = answer_to_probe(displacement);
    if (found.converged || found.met_negative_curvature) return found.converged;
    const auto mode = lowest_mode(displacement);
    return mode ? std::optional(mode->eigenvalue > 0) : std::nullopt;
  }

  /// The tangent at rest has no negative eigenvalue. It has no zero one if conjugate gradients reach every
  /// part of a random right side with a motion that meets resistance. If rounding alone resists, the answer
  /// is a huge motion, which stores next to no energy. On large bodies counting may spare this test; on small
  /// ones the test also shows whether the direct path has to take over.
  mechanics::RestState rest_state() override {
    using mechanics::RestState;
    if (n_unknowns() > 3 * most_factorised && is_rigid_by_faces(problem_.body)) return RestState::sound;
    const Vector rest = Vector::Zero(problem_.load.size());
    Vector image = rest;
    springs_.product(Clamp::no, rest, probe(), image);
    const double typical = dot(probe_, image) / dot(probe_, probe_); // N/mm
    if (!(typical > no_stiffness)) return RestState::mechanism;
    const LinearSolution found = answer_to_probe(rest);
    const Vector& motion = found.met_negative_curvature ? found.direction : found.solution;
    const double squared = dot(motion, motion);
    if (found.converged && dot(motion, probe_) > rounding * typical * squared) return RestState::sound;
    if (!(springs_.small_motion_energy(motion) > no_energy * typical * squared)) return RestState::mechanism;
    return found.converged ? RestState::sound : RestState::unknown;
  }

  std::optional<Mode> lowest_mode(const Vector& displacement) override {
    if (mode_at_.size() > 0 && !any_rank(mode_at_ != displacement)) return mode_;
    multigrid().linearise(displacement);
    const auto product = [&](const Vector& in, Vector& out) {
      springs_.product(Clamp::no, displacement, in, out);
    };
    const auto precondition = [&](const Vector& in, Vector& out) { multigrid().apply(in, out); };
    const auto dots = [&](const Vector& a, const Vector& b) { return dot(a, b); };
    const auto found = mechanics::grid::lowest_mode({product, precondition, dots, n_threads_}, probe());
    if (!found) return std::nullopt;
    mode_ = *found;
    mode_at_ = displacement;
    return mode_;
  }

  bool moves_supports() const override { return bool(problem_.supports); }

  std::size_t n_unknowns() const override { return problem_.n_unknowns; }

  int n_inverted(const Vector& displacement) override {
    const Body& body = problem_.body;
    int n = 0;
#pragma omp parallel for num_threads(n_threads_) reduction(+ : n) if (n_threads_ > 1)
    for (int k = 0; k < body.cells[2]; ++k)
      for (int j = 0; j < body.cells[1]; ++j)
        for (int i = 0; i < body.cells[0]; ++i) {
          if (body.part && !body.part->owns(i, j, k)) continue; // another rank counts it
          if (!body.is_uniform() && body.cell(i, j, k).is_empty()) continue;
          cases::CellCorners vertices(8);
          for (int v = 0; v < 8; ++v) {
            const int node[3] = {i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2)};
            for (int a = 0; a < 3; ++a)
              vertices[index(v)][a] =
                  node[a] * body.spacing[a] + displacement[body.layout.at(node[0], node[1], node[2], a)];
          }
          if (!(cases::smallest_corner_jacobian(vertices) > 0)) ++n;
        }
    double all = n;
    if (body.part) body.part->ranks->sum(&all, 1);
    return static_cast<int>(all);
  }

  void move_supports(Vector& displacement, double load_factor) const override {
    if (!problem_.supports) return;
    const Vector& there = problem_.supports(load_factor);
    for (const std::ptrdiff_t entry : problem_.body.constrained) displacement[entry] = there[entry];
  }

  double reaction(const Vector& displacement) override {
    reactions_.setZero(displacement.size());
    on_supports_.setZero(displacement.size());
    springs_.reactions(displacement, reactions_);
    for (const std::ptrdiff_t entry : problem_.body.constrained) on_supports_[entry] = reactions_[entry];
    return norm(problem_.body, on_supports_, n_threads_);
  }

 private:
  static constexpr int max_iterations = 300; ///< healthy lattices take 30
  static constexpr double rounding = 1e-12;  ///< relative eigenvalue: 1e-16 by rounding, 1e-8 softest lattice
  static constexpr double no_energy = 1e-18, no_stiffness = 1e-290; ///< as in the direct system

  const GridProblem& problem_;
  int n_threads_;
  SpringField<double> springs_;
  std::optional<SpringLevels> multigrid_; ///< none before it is asked for
  Vector probe_, mode_at_, reactions_, on_supports_, middle_, backwards_;
  Mode mode_{};

  SpringLevels& multigrid() {
    if (!multigrid_) multigrid_.emplace(problem_.body, n_threads_);
    return *multigrid_;
  }

  /// A fixed right side with a part in every motion.
  const Vector& probe() {
    if (probe_.size() == 0)
      probe_ = random_field<double>(problem_.body, 3, std::normal_distribution<double>());
    return probe_;
  }

  /// Conjugate gradients under the exact tangent for the probe, so far that no motion of negative stiffness
  /// is left out: while all curvatures are positive, a residual's part in such a motion only grows (the
  /// residual's polynomial has positive roots and is 1 at 0). A random right side has about 1/sqrt(n) of its
  /// length in any one of n motions, and less than a thousandth of that in one case of a thousand.
  LinearSolution answer_to_probe(const Vector& displacement) {
    const double target = 1e-3 / std::sqrt(static_cast<double>(std::max<std::size_t>(1, n_unknowns())));
    return solve_fresh(displacement, probe(), target, Clamp::no, 0);
  }

  bool solve(const Vector& displacement, const Vector& right_side, double forcing, Clamp clamp, double shift,
             Vector& step) override {
    LinearSolution found = solve_fresh(displacement, right_side, forcing, clamp, shift);
    step.swap(found.solution);
    return found.converged;
  }

  /// The cycle keeps what it learnt at the displacements before this one. After one where points coincide or
  /// fly off that may be wrong, and then a new cycle has to start afresh.
  LinearSolution solve_fresh(const Vector& displacement, const Vector& right_side, double forcing,
                             Clamp clamp, double shift) {
    const auto apply = [&](const Vector& v, Vector& out) {
      springs_.product(clamp, displacement, v, out);
      if (shift != 0) add(out, shift, v, n_threads_);
    };
    for (const bool may_be_misled : {true, false}) {
      multigrid().linearise(displacement);
      auto found = mechanics::grid::conjugate_gradients(
          apply, [&](const Vector& v, Vector& out) { multigrid().apply(v, out); }, right_side,
          forcing * norm(problem_.body, right_side, n_threads_), max_iterations,
          [&](const Vector& a, const Vector& b) { return dot(a, b); }, n_threads_);
      work_.linear_iterations += found.iterations;
      if (found.converged || found.met_negative_curvature || !may_be_misled) return found;
      multigrid_.emplace(problem_.body, n_threads_);
    }
    return {}; // not reached
  }
};

} // namespace

GridProblem make_grid_problem(const Problem& problem, const std::vector<CellStiffness>& stiffness,
                              const DealOut& deal_out) {
  const cases::Grid& grid = *problem.mesh.grid;
  GridProblem result;
  result.n_unknowns = n_unknowns(problem);
  Body& body = result.body;
  body.cells = grid.cells;
  body.spacing = grid.spacing;
  body.exponents = stiffness.front().exponents;
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
  const Layout layout = body.layout = make_layout(body.cells);
  std::vector<bool> is_constrained(index(3 * layout.size));
  for_each_node(problem, body, [&](std::size_t n, const std::array<int, 3>& at) {
    for (int c = 0; c < 3; ++c)
      is_constrained[index(layout.at(at[0], at[1], at[2], c))] = problem.is_constrained[3 * n + index(c)];
  });
  set_layout(body, [&](int i, int j, int k, int c) { return is_constrained[index(layout.at(i, j, k, c))]; });
  if (deal_out) body = deal_out(std::move(body));
  result.load = to_field(problem, body, problem.force);
  clear_constrained(body, result.load);
  if (problem.supports) {
    std::vector<std::ptrdiff_t> places; // entries of the points that move; -1: not here
    for (const auto& [node, value] : problem.supports(0)) {
      const auto at = place_of(problem, body, index(node));
      places.push_back(at ? body.layout.at((*at)[0], (*at)[1], (*at)[2]) : -1);
    }
    result.supports = [&problem, places = std::move(places), n = body.layout.size,
                       field = Field<double>(Field<double>::Zero(3 * body.layout.size))](
                          double load_factor) mutable -> const Field<double>& {
      auto place = places.begin();
      for (const auto& moved : problem.supports(load_factor)) {
        for (int c = 0; *place >= 0 && c < 3; ++c) field[*place + c * n] = moved.value[c];
        ++place;
      }
      return field;
    };
  }
  return result;
}

std::unique_ptr<GridSystem> make_grid_system(const GridProblem& problem, int n_threads) {
  return std::make_unique<MatrixFreeSystem>(problem, n_threads);
}

std::optional<Vector> coarse_guess(const GridProblem& problem, int n_threads) {
  const std::optional<Body> body = coarsen(problem.body);
  if (!body) return std::nullopt;
  GridProblem coarse{*body, {}, {}, 0};
  const Layout& layout = coarse.body.layout;
  if (!body->part && layout.nodes[0] * layout.nodes[1] * layout.nodes[2] < 60) return std::nullopt;
  const Transfer<double> transfer(problem.body, coarse.body, n_threads);
  coarse.load.setZero(3 * layout.size);
  transfer.restrict(problem.load, coarse.load);
  const auto system = make_grid_system(coarse, n_threads);
  const Vector rest = Vector::Zero(coarse.load.size());
  const std::optional<Vector> found =
      mechanics::grid::find_guess(*system, rest, "coarse lattice", {}, {coarse_guess(coarse, n_threads)})
          .state;
  if (!on_all_ranks(problem.body, found.has_value())) return std::nullopt;
  Vector guess = Vector::Zero(problem.load.size());
  transfer.prolong(*found, guess);
  update_ghosts(problem.body, guess); // a coarse answer that every rank found by itself is rounded by itself
  return guess;
}

Points to_points(const Problem& problem, const Body& body, const Field<double>& field,
                 const cases::Sharing* sharing) {
  std::vector<cases::Numbered<Eigen::Vector3d>> own;
  for_each_node(problem, body, [&](std::size_t n, const std::array<int, 3>& at) {
    if (body.part && !body.part->owns(at[0], at[1], at[2])) return;
    if (!body.part && sharing && !sharing->here().own_nodes.has(n)) return; // every rank has all of the body
    Eigen::Vector3d point;
    for (int c = 0; c < 3; ++c) point[c] = field[body.layout.at(at[0], at[1], at[2], c)];
    own.push_back({static_cast<std::int64_t>(n), point});
  });
  return cases::deal(sharing, std::move(own), problem.mesh.nodes.size(), Eigen::Vector3d(0, 0, 0));
}

Field<double> to_field(const Problem& problem, const Body& body, const Points& points) {
  Field<double> field = Field<double>::Zero(3 * body.layout.size);
  for_each_node(problem, body, [&](std::size_t n, const std::array<int, 3>& at) {
    for (int c = 0; c < 3; ++c) field[body.layout.at(at[0], at[1], at[2], c)] = points[n][c];
  });
  return field;
}

} // namespace springproof::msm::grid
