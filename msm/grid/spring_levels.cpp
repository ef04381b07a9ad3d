#include "msm/grid/spring_levels.hpp"

#include "msm/grid/merged_cells.hpp"
#include "msm/grid/transfer.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <utility>

namespace springproof::msm::grid {

using cases::index;
using mechanics::grid::Chebyshev;

namespace {

constexpr double nearby = 1e-3;                  ///< relative to the shortest edge of a cell
constexpr std::ptrdiff_t n_coarsest_nodes = 100; ///< a dense factorisation of 300 unknowns takes about 1 ms

/// Calls action(stiffness) for all stiffnesses of a body.
template<class AnyBody, class Action>
void for_each_stiffness(AnyBody& body, const Action& action) {
  for (auto& cell : body.springs) {
    for (auto& edge : cell.edge) action(edge);
    for (auto& diagonal : cell.face_diagonal) action(diagonal);
    action(cell.internal_diagonal);
    for (auto& midline : cell.midline) action(midline);
    action(cell.volume);
  }
}

/// A preconditioner may have any scale. This one keeps single precision in range, and changes no other digit.
double scale_of(const Body& finest) {
  double largest = 0; // maximum over all ranks
  for_each_stiffness(finest, [&](double k) { largest = std::max(largest, k); });
  if (finest.part) largest = finest.part->ranks->largest(largest);
  return std::ldexp(1, largest > 0 ? -std::ilogb(largest) : 0);
}

bool is_large(const Layout& layout) {
  return std::ptrdiff_t{layout.nodes[0]} * layout.nodes[1] * layout.nodes[2] > n_coarsest_nodes;
}

bool is_merged(const Body& body) {
  return !body.is_uniform() && !body.part;
}

/// A body and, where they are no merged cells, ever coarser ones; the last is no part.
std::deque<Body> coarsenings(const Body& finest, double scale) {
  std::deque<Body> bodies{finest};
  while (!is_merged(finest) && (bodies.back().part || is_large(bodies.back().layout)))
    if (std::optional<Body> coarse = coarsen(bodies.back()))
      bodies.push_back(std::move(*coarse));
    else
      break;
  for (Body& body : bodies) body = scaled(std::move(body), scale);
  return bodies;
}

} // namespace

Body scaled(Body body, double factor) {
  for_each_stiffness(body, [&](double& k) { k *= factor; });
  return body;
}

/// A lattice's clamped tangent.
class SpringLevels::SpringLevel : public mechanics::grid::Level {
 public:
  SpringLevel(const Body& body, const SpringLevel* finer, int n_threads)
      : Level(3 * body.layout.size, n_threads), displacement(Field<float>::Zero(3 * body.layout.size)),
        body_(body), springs_(body, n_threads), keeps_(springs_.keep_tangent()), finer_(finer) {
    if (finer) transfer_.emplace(finer->body_, body, n_threads);
  }

  Field<float> displacement;
  Field<float> diagonal;         ///< added to that of the springs; empty: none
  Operator joined;               ///< added to the product; empty: none
  std::vector<NodeBlock> blocks; ///< added too

  /// Sets the blocks from the finer level's. Nodes' blocks are two fields of vectors: xx, yy, zz and yz, xz,
  /// xy.
  void restrict_blocks() {
    Field<float> fine[2], coarse[2];
    const std::ptrdiff_t n = body_.layout.size, n_fine = finer_->body_.layout.size;
    for (int half = 0; half < 2; ++half) {
      fine[half].setZero(3 * n_fine);
      coarse[half].setZero(3 * n);
      for (const auto& [x, block] : finer_->blocks)
        for (int c = 0; c < 3; ++c)
          fine[half][x + c * n_fine] = half == 0 ? block(c, c) : block((c + 1) % 3, (c + 2) % 3);
      transfer_->restrict(fine[half], coarse[half]);
    }
    blocks.clear();
    for (std::ptrdiff_t x = 0; x < n; ++x) {
      const Eigen::Vector3f on(coarse[0][x], coarse[0][x + n], coarse[0][x + 2 * n]),
          off(coarse[1][x], coarse[1][x + n], coarse[1][x + 2 * n]);
      if (on.isZero(0)) continue;
      Eigen::Matrix3f block = on.asDiagonal();
      for (int c = 0; c < 3; ++c) block((c + 1) % 3, (c + 2) % 3) = block((c + 2) % 3, (c + 1) % 3) = off[c];
      blocks.push_back({x, block});
    }
  }

  /// Brings the inverse diagonal to the blocks, which others had been added to.
  void replace_blocks_in_inverse() {
    if (inverse_diagonal_.size() == 0) return; // the cycle ends at a finer level
    for (const auto& [x, inverse] : without_blocks_)
      for (int c = 0; c < 6; ++c) inverse_diagonal_[x + c * body_.layout.size] = inverse[index(c)];
    without_blocks_.clear();
    add_blocks_to_inverse();
  }

  void restrict_diagonal() {
    diagonal.setZero(displacement.size());
    transfer_->restrict(finer_->diagonal, diagonal);
  }

  void linearise() override {
    if (finer_) transfer_->sample(finer_->displacement, displacement);
    springs_.inverse_diagonal(Clamp::yes, displacement, inverse_diagonal_, diagonal);
    without_blocks_.clear();
    add_blocks_to_inverse();
    constexpr float small = 0.1f; // share of the masses below which the smoother does without
    has_joined_ = joined && diagonal.cwiseProduct(inverse_diagonal_.head(diagonal.size())).maxCoeff() > small;
  }
  void multiply(Field<float>& direction, Field<float>& product) const override {
    if (keeps_)
      springs_.kept_product(displacement, direction, product);
    else
      springs_.product(Clamp::yes, displacement, direction, product);
    if (diagonal.size() > 0) add_product(product, diagonal, direction, n_threads_);
    if (has_joined_) joined(direction, product);
    add_blocks(blocks, body_.layout.size, direction, product);
  }
  double norm(const Field<float>& field) const override { return grid::norm(body_, field, n_threads_); }
  void set_rough(Field<float>& rough) const override {
    rough = random_field<float>(body_, 1, std::uniform_real_distribution<float>(-1, 1));
  }
  void complete(Field<float>& solution) const override { update_ghosts(body_, solution); }

  /// No eigenvalue of the preconditioned matrix is much below the least share of the added diagonal in a
  /// diagonal block.
  bool needs_no_coarser(const Chebyshev& smoother) const override {
    if (diagonal.size() == 0 || body_.part || is_merged(body_)) return false;
    const auto inverse = inverse_diagonal_.head(diagonal.size()).array(); // xx, yy, zz
    const float least =
        (inverse > 0).select(diagonal.array() * inverse, std::numeric_limits<float>::infinity()).minCoeff();
    return least * static_cast<float>(smoother.share) >= static_cast<float>(largest_eigenvalue_);
  }

  bool factorise() override {
    Eigen::MatrixXd& matrix = factor_.begin(
        displacement.size(), [&](std::ptrdiff_t entry) { return inverse_diagonal_[entry] > 0; });
    solution_.setZero();
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      float& entry = solution_[factor_.unknowns[index(column)]];
      entry = 1;
      multiply(solution_, product_);
      entry = 0;
      for (Eigen::Index row = 0; row < matrix.rows(); ++row)
        matrix(row, column) = static_cast<double>(product_[factor_.unknowns[index(row)]]);
    }
    factor_.factorise(decltype(factor_)::Indefinite::shift);
    return true;
  }
  void solve_exactly() override { factor_.solve(residual_, solution_); }

  void restrict_from(Field<float>& finer_residual) override {
    transfer_->restrict(finer_residual, residual_);
  }
  void prolong_to(Field<float>& finer_correction) override {
    transfer_->prolong(solution_, finer_correction);
  }

 private:
  void add_blocks_to_inverse() {
    for (NodeBlock& added : blocks) {
      std::array<float, 6>& before = without_blocks_.emplace_back(added.x, std::array<float, 6>{}).second;
      for (int c = 0; c < 6; ++c) before[index(c)] = inverse_diagonal_[added.x + c * body_.layout.size];
      add_to_inverse(added);
    }
  }

  /// Makes a node's inverse D that of its block with another one, B: (D^-1 + B)^-1 = D (1 + B D)^-1.
  /// Takes constrained components out of B.
  void add_to_inverse(NodeBlock& added) {
    const std::ptrdiff_t n = body_.layout.size;
    const auto entry = [&](int i, int j) -> float& { // xx, yy, zz, yz, xz, xy
      return inverse_diagonal_[added.x + n * (i == j ? i : 6 - i - j)];
    };
    Eigen::Matrix3f inverse;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inverse(i, j) = entry(i, j);
    for (int i = 0; i < 3; ++i)
      if (!(inverse(i, i) > 0)) {
        added.block.row(i).setZero();
        added.block.col(i).setZero();
      }
    const Eigen::Matrix3f both = inverse * (Eigen::Matrix3f::Identity() + added.block * inverse).inverse();
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) entry(i, j) = (both(i, j) + both(j, i)) / 2;
  }

  const Body& body_;
  bool has_joined_ = false;
  std::vector<std::pair<std::ptrdiff_t, std::array<float, 6>>> without_blocks_; ///< inverses, by nodes' x
  SpringField<float> springs_;
  bool keeps_; ///< springs_ do, their tangent
  const SpringLevel* finer_;
  std::optional<Transfer<float>> transfer_; ///< between the finer level and this one
  mechanics::grid::DenseFactor<double> factor_;
};

SpringLevels::SpringLevels(const Body& finest, int n_threads, const Chebyshev& smoother)
    : n_threads_(n_threads), scale_(scale_of(finest)), bodies_(coarsenings(finest, scale_)),
      cycle_({smoother, 1.15, 12}, n_threads) {
  for (const Body& body : bodies_) {
    auto level = std::make_unique<SpringLevel>(body, rediscretised_.empty() ? nullptr : rediscretised_.back(),
                                               n_threads);
    rediscretised_.push_back(level.get());
    cycle_.levels.push_back(std::move(level));
  }
  const SpringLevel& first = *rediscretised_.front();
  if (is_merged(finest) && is_large(finest.layout))
    add_merged_levels(bodies_.front(), first.displacement, first.diagonal, n_threads, cycle_.levels);
}

void SpringLevels::set_diagonal(const Field<double>& diagonal, Operator joined) {
  rediscretised_.front()->joined = std::move(joined);
  rediscretised_.front()->diagonal.resize(diagonal.size());
  for_each_piece(diagonal.size(), n_threads_, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    rediscretised_.front()->diagonal.segment(first, n) = diagonal.segment(first, n).cast<float>();
  });
  for (std::size_t l = 1; l < rediscretised_.size(); ++l) rediscretised_[l]->restrict_diagonal();
  is_linearised_ = false;
}

void SpringLevels::set_blocks(std::vector<NodeBlock> blocks) {
  rediscretised_.front()->blocks = std::move(blocks);
  for (std::size_t l = 1; l < rediscretised_.size(); ++l) rediscretised_[l]->restrict_blocks();
  if (!is_linearised_) return;
  for (SpringLevel* level : rediscretised_) level->replace_blocks_in_inverse();
  if (rediscretised_.size() == cycle_.levels.size()) cycle_.factorise_again();
}

void SpringLevels::linearise(const Field<double>& displacement) {
  const Body& finest = bodies_.front();
  // A preconditioner may come from a place nearby.
  if (is_linearised_ &&
      on_all_ranks(finest, (linearised_at_ - displacement).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <=
                               nearby * finest.spacing.minCoeff()))
    return;
  linearised_at_ = displacement;
  is_linearised_ = true;
  for_each_piece(displacement.size(), n_threads_, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    rediscretised_.front()->displacement.segment(first, n) = displacement.segment(first, n).cast<float>();
  });
  cycle_.linearise();
}

void SpringLevels::apply(const Field<double>& right_side, Field<double>& solution) {
  cycle_.apply(right_side, norm(bodies_.front(), right_side, n_threads_), solution);
}

} // namespace springproof::msm::grid
