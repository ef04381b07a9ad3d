#include "msm/grid/multigrid.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace springproof::msm::grid {

namespace {

using mechanics::grid::apply_blocks;

constexpr double nearby = 1e-3;                  ///< of the shortest edge of a cell
constexpr std::ptrdiff_t n_coarsest_nodes = 100; ///< a dense factorisation of 300 unknowns takes about 1 ms

/// Calls action(stiffness) for all stiffnesses of a body.
template<class AnyBody, class Action>
void for_each_stiffness(AnyBody& body, const Action& action) {
  for (auto& cell : body.springs) {
    for (auto& edge : cell.edge) action(edge);
    for (auto& diagonal : cell.face_diagonal) action(diagonal);
    action(cell.internal_diagonal);
    action(cell.volume);
  }
}

/// A power of two near the largest stiffness, of all ranks.
int exponent_of_stiffness(const Body& body) {
  double largest = 0;
  for_each_stiffness(body, [&](double k) { largest = std::max(largest, k); });
  if (body.part) largest = body.part->ranks->largest(largest);
  return largest > 0 ? std::ilogb(largest) : 0;
}

} // namespace

double scale_of(const Body& finest) {
  return std::ldexp(1, -exponent_of_stiffness(finest));
}

std::deque<Body> coarsenings(const Body& finest) {
  std::deque<Body> bodies{finest};
  const auto is_large = [](const Layout& layout) {
    return std::ptrdiff_t{layout.nodes[0]} * layout.nodes[1] * layout.nodes[2] > n_coarsest_nodes;
  };
  while (bodies.back().part || is_large(bodies.back().layout))
    if (std::optional<Body> coarse = coarsen(bodies.back()))
      bodies.push_back(std::move(*coarse));
    else
      break;
  // A preconditioner may have any scale. This one keeps single precision in range, and changes no other
  // digit.
  const double scale = scale_of(finest);
  for (Body& body : bodies) body = scaled(std::move(body), scale);
  return bodies;
}

Body scaled(Body body, double factor) {
  for_each_stiffness(body, [&](double& k) { k *= factor; });
  return body;
}

Multigrid::Level::Level(const Body& of, int n_threads)
    : body(of), springs(of, n_threads),
      rough(random_field<float>(of, 1, std::uniform_real_distribution<float>(-1, 1))) {
  for (Field<float>* field : {&displacement, &solution, &residual, &correction, &product})
    field->setZero(3 * of.layout.size);
}

Multigrid::Multigrid(const std::deque<Body>& bodies, int n_threads,
                     const mechanics::grid::Chebyshev& smoother)
    : smoother_(smoother), n_threads_(n_threads) {
  for (const Body& body : bodies) levels_.emplace_back(body, n_threads);
  for (std::size_t l = 0; l + 1 < bodies.size(); ++l)
    transfers_.emplace_back(bodies[l], bodies[l + 1], n_threads);
  const Body& finest = bodies.front();
  if (!finest.is_uniform() && !finest.part && bodies.size() > 1) {
    merged_.emplace(finest, smoother, n_threads);
    while (levels_.size() > 1) levels_.pop_back();
    transfers_.clear();
    return;
  }
  const Body& last = bodies.back();
  for (int c = 0; c < 3; ++c)
    for_each_place(last.layout.nodes, [&](int i, int j, int k) {
      const std::ptrdiff_t entry = last.layout.at(i, j, k, c);
      if (!std::binary_search(last.constrained.begin(), last.constrained.end(), entry))
        coarsest_unknowns_.push_back(entry);
    });
}

void Multigrid::set_diagonal(const Field<double>& diagonal) {
  for (Level& level : levels_) level.diagonal.resize(3 * level.body.layout.size);
  for_each_piece(diagonal.size(), n_threads_, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    levels_.front().diagonal.segment(first, n) = diagonal.segment(first, n).cast<float>();
  });
  for (std::size_t l = 0; l < transfers_.size(); ++l) {
    levels_[l + 1].diagonal.setZero();
    transfers_[l].restrict(levels_[l].diagonal, levels_[l + 1].diagonal);
  }
  is_linearised_ = false;
}

void Multigrid::linearise(const Field<double>& displacement) {
  const Body& finest = levels_.front().body;
  // A preconditioner may be of a place nearby.
  if (is_linearised_ &&
      on_all_ranks(finest, (linearised_at_ - displacement).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <=
                               nearby * finest.spacing.minCoeff()))
    return;
  linearised_at_ = displacement;
  is_linearised_ = true;
  for_each_piece(displacement.size(), n_threads_, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    levels_.front().displacement.segment(first, n) = displacement.segment(first, n).cast<float>();
  });
  for (std::size_t l = 0; l < transfers_.size(); ++l)
    transfers_[l].sample(levels_[l].displacement, levels_[l + 1].displacement);
  for (last_ = 0;; ++last_) {
    Level& level = levels_[last_];
    if (last_ + 1 == levels_.size() && !merged_) return factorise_coarsest();
    level.springs.inverse_diagonal(Clamp::yes, level.displacement, level.inverse_diagonal, level.diagonal);
    estimate_largest_eigenvalue(level);
    if (merged_) return merged_->linearise(level.displacement, level.diagonal);
    if (needs_no_coarser(level)) return;
  }
}

void Multigrid::multiply(const Level& level, const Field<float>& direction, Field<float>& product) const {
  level.springs.product(Clamp::yes, level.displacement, direction, product);
  if (level.diagonal.size() == 0) return;
  add_product(product, level.diagonal, direction, n_threads_);
}

/// Of the preconditioned matrix no eigenvalue is much less than the least share that the added diagonal has
/// in an inverse block.
bool Multigrid::needs_no_coarser(const Level& level) const {
  if (level.diagonal.size() == 0 || level.body.part) return false;
  const std::ptrdiff_t n = level.diagonal.size();
  const auto inverse = level.inverse_diagonal.head(n).array(); // xx, yy, zz
  const float least = (inverse > 0)
                          .select(level.diagonal.array() * inverse, std::numeric_limits<float>::infinity())
                          .minCoeff();
  return least * static_cast<float>(smoother_.share) >= static_cast<float>(level.largest_eigenvalue);
}

/// Of the inverse diagonal times the tangent, by the power method; its vector is kept for the next time.
void Multigrid::estimate_largest_eigenvalue(Level& level) {
  const int n_steps = level.largest_eigenvalue > 0 ? 2 : 12;
  for (int step = 0; step < n_steps; ++step) {
    const double length = norm(level.body, level.rough, n_threads_);
    multiply(level, level.rough, level.product);
    apply_blocks(level.inverse_diagonal.data(), level.product, level.rough, 0, static_cast<float>(1 / length),
                 n_threads_);
    level.largest_eigenvalue = norm(level.body, level.rough, n_threads_);
  }
}

void Multigrid::factorise_coarsest() {
  Level& level = levels_.back();
  const auto n = static_cast<Eigen::Index>(coarsest_unknowns_.size());
  if (n == 0) return; // nothing is free to move
  Eigen::MatrixXd& matrix = coarsest_matrix_;
  matrix.resize(n, n);
  level.solution.setZero();
  for (Eigen::Index column = 0; column < n; ++column) {
    float& entry = level.solution[coarsest_unknowns_[static_cast<std::size_t>(column)]];
    entry = 1;
    multiply(level, level.solution, level.product);
    entry = 0;
    for (Eigen::Index row = 0; row < n; ++row)
      matrix(row, column) =
          static_cast<double>(level.product[coarsest_unknowns_[static_cast<std::size_t>(row)]]);
  }
  for (Eigen::Index column = 0; column < n; ++column)
    for (Eigen::Index row = 0; row < column; ++row)
      matrix(row, column) = matrix(column, row) = 0.5 * (matrix(row, column) + matrix(column, row));
  // Single precision leaves the matrix uncertain by about 1e-7 of its diagonal; a preconditioner may be that
  // stiff.
  const double shift = 1e-6 * matrix.diagonal().cwiseAbs().maxCoeff();
  matrix.diagonal().array() += shift;
  coarsest_.compute(matrix);
  for (double more = 10 * shift; coarsest_.info() != Eigen::Success && more < 1e9 * shift; more *= 10) {
    matrix.diagonal().array() += more;
    coarsest_.compute(matrix);
  }
}

/// Adds the correction to the solution, and takes it from the residual when that is wanted.
void Multigrid::correct(Level& level, bool keeps_residual) {
  add(level.solution, 1.0f, level.correction, n_threads_);
  if (!keeps_residual) return;
  multiply(level, level.correction, level.product);
  add(level.residual, -1.0f, level.product, n_threads_);
}

void Multigrid::smooth(Level& level, bool keeps_residual) {
  const auto precondition = [&](float keep, float factor) {
    apply_blocks(level.inverse_diagonal.data(), level.residual, level.correction, keep, factor, n_threads_);
  };
  mechanics::grid::smooth(
      smoother_, 1.15 * level.largest_eigenvalue, // the power method comes from below
      precondition, [&](bool keeps) { correct(level, keeps); }, keeps_residual);
}

/// Solves for the residual of level l; the level's solution is the answer.
void Multigrid::cycle(std::size_t l) {
  Level& level = levels_[l];
  level.solution.setZero();
  if (l + 1 == levels_.size() && !merged_) {
    const auto n = static_cast<Eigen::Index>(coarsest_unknowns_.size());
    if (n == 0) return;
    coarsest_answer_.resize(n);
    for (Eigen::Index u = 0; u < n; ++u)
      coarsest_answer_[u] =
          static_cast<double>(level.residual[coarsest_unknowns_[static_cast<std::size_t>(u)]]);
    coarsest_.solveInPlace(coarsest_answer_);
    for (Eigen::Index u = 0; u < n; ++u)
      level.solution[coarsest_unknowns_[static_cast<std::size_t>(u)]] =
          static_cast<float>(coarsest_answer_[u]);
    return;
  }
  if (l == last_ && !merged_) return smooth(level, false);
  smooth(level, true);
  if (merged_) {
    merged_->correct(level.residual, level.correction);
  } else {
    transfers_[l].restrict(level.residual, levels_[l + 1].residual);
    cycle(l + 1);
    transfers_[l].prolong(levels_[l + 1].solution, level.correction);
  }
  correct(level, true);
  smooth(level, false);
}

void Multigrid::whole_cycle() {
  cycle(0);
  // Every rank has coarse levels of its own, which another kind of machine rounds differently.
  update_ghosts(levels_.front().body, levels_.front().solution);
}

void Multigrid::apply(const Field<double>& right_side, Field<double>& solution) {
  Level& level = levels_.front();
  mechanics::grid::apply_in_single_precision(
      right_side, norm(level.body, right_side, n_threads_), level.residual, level.solution, solution,
      [&] { whole_cycle(); }, n_threads_);
}

void Multigrid::apply(const Field<float>& right_side, Field<float>& solution) {
  Level& level = levels_.front();
  level.residual = right_side;
  whole_cycle();
  level.solution.swap(solution); // a cycle begins with none
}

} // namespace springproof::msm::grid
