#include "mechanics/grid/cycle.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace springproof::mechanics::grid {

namespace {

/// Whether the pivots of the symmetric matrix with this lower triangle are positive.
bool is_definite(const Eigen::Matrix3d& lower) {
  const double first = lower(0, 0), second = lower(1, 1) - lower(1, 0) * lower(1, 0) / first;
  const double coupling = lower(2, 1) - lower(2, 0) * lower(1, 0) / first;
  const double third = lower(2, 2) - lower(2, 0) * lower(2, 0) / first - coupling * coupling / second;
  return first > 0 && second > 0 && third > 0;
}

} // namespace

Eigen::Matrix3d inverse_on_free(Eigen::Matrix3d block, const bool (&is_free)[3], double singular_below) {
  for (int c = 0; c < 3; ++c) {
    if (is_free[c]) continue;
    block.row(c).setZero();
    block.col(c).setZero();
    block(c, c) = 1;
  }
  // Blocks of log_strain are not symmetric. Judged by their lower triangle, they are taken as definite
  // less often: by their minors, cycles of unstable states took twice the iterations.
  Eigen::Matrix3d inverse;
  if (block.determinant() > singular_below * block.diagonal().prod() && is_definite(block))
    inverse = block.inverse();
  else
    inverse = block.diagonal().cwiseAbs().cwiseInverse().asDiagonal();
  for (int c = 0; c < 3; ++c)
    if (!is_free[c]) inverse(c, c) = 0;
  return inverse;
}

template<class Scalar>
void DenseFactor<Scalar>::factorise(Indefinite indefinite) {
  if (matrix_.size() == 0) return; // nothing is free to move
  for (Eigen::Index column = 0; column < matrix_.cols(); ++column)
    for (Eigen::Index row = 0; row < column; ++row)
      matrix_(row, column) = matrix_(column, row) =
          Scalar(0.5) * (matrix_(row, column) + matrix_(column, row));
  // Single precision leaves the matrix uncertain by about 1e-7 of its diagonal; a preconditioner may be that
  // stiff.
  const Scalar shift = Scalar(1e-6) * matrix_.diagonal().cwiseAbs().maxCoeff();
  matrix_.diagonal().array() += shift;
  factor_.compute(matrix_);
  if (factor_.info() == Eigen::Success) return;
  if (indefinite == Indefinite::reflect) {
    const Eigen::SelfAdjointEigenSolver<Matrix> modes(matrix_);
    const Eigen::Matrix<Scalar, Eigen::Dynamic, 1> sizes = modes.eigenvalues().cwiseAbs().cwiseMax(shift);
    factor_.compute(modes.eigenvectors() * sizes.asDiagonal() * modes.eigenvectors().transpose());
    return;
  }
  for (Scalar more = 10 * shift; factor_.info() != Eigen::Success && more < Scalar(1e9) * shift; more *= 10) {
    matrix_.diagonal().array() += more;
    factor_.compute(matrix_);
  }
}

template<class Scalar>
void DenseFactor<Scalar>::solve(const Field<float>& right_side, Field<float>& solution) {
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  if (n == 0) return;
  answer_.resize(n);
  for (Eigen::Index u = 0; u < n; ++u)
    answer_[u] = static_cast<Scalar>(right_side[unknowns[static_cast<std::size_t>(u)]]);
  factor_.solveInPlace(answer_);
  for (Eigen::Index u = 0; u < n; ++u)
    solution[unknowns[static_cast<std::size_t>(u)]] = static_cast<float>(answer_[u]);
}

template class DenseFactor<float>;
template class DenseFactor<double>;

Level::Level(std::ptrdiff_t size, int n_threads) : n_threads_(n_threads) {
  for (Field<float>* field : {&solution_, &residual_, &correction_, &product_, &rough_}) field->setZero(size);
}

void Level::precondition(const Field<float>& in, Field<float>& out, float keep, float factor) const {
  const std::ptrdiff_t n = in.size() / 3;
  for_each_piece(n, n_threads_, [&](std::ptrdiff_t first, std::ptrdiff_t length) {
    apply_blocks(inverse_diagonal_.data() + first, in.data() + first, out.data() + first, n, keep, factor,
                 length);
  });
}

void Cycle::linearise() {
  for (last_ = 0;; ++last_) {
    Level& level = *levels[last_];
    const bool is_coarsest = last_ + 1 == levels.size();
    level.linearise();
    ends_exactly_ = is_coarsest && level.factorise();
    if (ends_exactly_) return;
    estimate_largest_eigenvalue(level);
    if (is_coarsest || level.needs_no_coarser(settings_.smoother)) return;
  }
}

void Cycle::factorise_again() {
  if (ends_exactly_) levels[last_]->factorise();
}

void Level::forget() {
  largest_eigenvalue_ = 0;
  for (Field<float>* field : {&solution_, &residual_, &correction_, &product_})
    field->setZero(); // 0 times what is not a number is not 0
}

void Cycle::forget() {
  for (const auto& level : levels) level->forget();
}

/// Runs the power method, whose vector is kept for the next time.
void Cycle::estimate_largest_eigenvalue(Level& level) const {
  const bool is_first = !(level.largest_eigenvalue_ > 0 && std::isfinite(level.largest_eigenvalue_));
  if (is_first) {
    level.forget();
    level.set_rough(level.rough_);
  }
  for (int step = 0; step < (is_first ? settings_.first_power_steps : 2); ++step) {
    const double length = level.largest_eigenvalue_ = level.norm(level.rough_);
    if (!(length > 0)) return; // nothing moves, or what moved was no number
    level.multiply(level.rough_, level.product_);
    level.precondition(level.product_, level.rough_, 0, static_cast<float>(1 / length));
    level.largest_eigenvalue_ = level.norm(level.rough_);
  }
}

/// Adds the correction to the solution, and takes its product from the residual when that is wanted.
void Cycle::correct(Level& level, bool keeps_residual) const {
  add(level.solution_, 1.0f, level.correction_, n_threads_);
  if (!keeps_residual) return;
  level.multiply(level.correction_, level.product_);
  add(level.residual_, -1.0f, level.product_, n_threads_);
}

void Cycle::smooth(Level& level, bool keeps_residual) const {
  grid::smooth(
      settings_.smoother, settings_.margin * level.largest_eigenvalue_,
      [&](float keep, float factor) { level.precondition(level.residual_, level.correction_, keep, factor); },
      [&](bool keeps) { correct(level, keeps); }, keeps_residual);
}

/// Solves for the residual of level l; the level's solution is the answer.
void Cycle::run(std::size_t l) const {
  Level& level = *levels[l];
  level.solution_.setZero();
  if (l == last_ && ends_exactly_) return level.solve_exactly();
  if (level.largest_eigenvalue_ == 0) return; // nothing moves
  if (l == last_) return smooth(level, false);
  smooth(level, true);
  Level& coarser = *levels[l + 1];
  coarser.restrict_from(level.residual_);
  run(l + 1);
  coarser.prolong_to(level.correction_);
  correct(level, true);
  smooth(level, false);
}

void Cycle::apply(const Field<double>& right_side, double norm, Field<double>& solution) {
  if (!(norm > 0)) {
    solution.setZero();
    return;
  }
  Level& finest = *levels.front();
  for_each_piece(right_side.size(), n_threads_, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    finest.residual_.segment(first, n) = (right_side.segment(first, n) / norm).cast<float>();
  });
  run(0);
  finest.complete(finest.solution_);
  for_each_piece(right_side.size(), n_threads_, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    solution.segment(first, n) = norm * finest.solution_.segment(first, n).cast<double>();
  });
}

void Cycle::apply(const Field<float>& right_side, Field<float>& solution) {
  Level& finest = *levels.front();
  finest.residual_ = right_side;
  run(0);
  finest.complete(finest.solution_);
  finest.solution_.swap(solution); // a cycle begins with none
}

} // namespace springproof::mechanics::grid
