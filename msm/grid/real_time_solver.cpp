#include "msm/grid/real_time_solver.hpp"

#include <utility>

namespace springproof::msm::grid {

RealTimeSolver::RealTimeSolver(const Body& body, const NodeVectors& vectors, double scale,
                               const std::optional<Body>& damping, const CellMasses* masses, int n_threads)
    : vectors_(vectors), scale_(scale), n_threads_(n_threads), body_(scaled(body, scale)),
      springs_(body_, n_threads) {
  if (masses) masses_.emplace(body_, *masses, n_threads);
  if (!damping) return;
  damping_body_ = scaled(*damping, scale);
  damping_.emplace(*damping_body_, n_threads);
  rest_.setZero(3 * body.layout.size);
  damped_ = rest_;
}

void RealTimeSolver::set_step(const Vector& diagonal, double mass, double damping) {
  vectors_.to_field(diagonal, scale_, diagonal_);
  mass_factor_ = mass;
  damping_factor_ = damping;
}

void RealTimeSolver::set_pull(const std::optional<Pull>& pull) {
  pull_.reset();
  with_pull_.reset();
  if (!pull) return;
  Pull::Entries entries = pull->entries();
  for (auto& component : entries)
    for (Pull::Entry& entry : component) entry.at = vectors_.in_field(entry.at);
  pull_.emplace(std::move(entries), scale_ * pull->stiffness());
}

void RealTimeSolver::has_cycle_changed() {
  if (with_pull_ && with_pull_->matters()) with_pull_.reset();
}

void RealTimeSolver::multiply(Clamp clamp, const Field<float>& direction, Field<float>& product) {
  springs_.product(clamp, at_, direction, product);
  if (masses_) masses_->add_product(scale_ * mass_factor_, scale_ * damping_factor_, direction, product);
  add_product(product, diagonal_, direction, n_threads_);
  if (damping_) {
    damping_->product(Clamp::yes, rest_, direction, damped_); // the same at rest, in less time
    add(product, static_cast<float>(damping_factor_), damped_, n_threads_);
  }
  add_blocks(blocks_, body_.layout.size, direction, product);
  if (pull_) pull_->add_product(direction, product);
}

const mechanics::grid::LinearSolutionIn<float>& RealTimeSolver::solve(const Vector& at, Clamp clamp,
                                                                      const Vector& right_side, double size,
                                                                      double forcing, int most_iterations,
                                                                      SpringLevels& cycle, Vector& solution) {
  vectors_.to_field(at, 1, at_);
  vectors_.to_field(right_side, size > 0 ? 1 / size : 0, right_side_);
  const auto precondition = [&](const Field<float>& v, Field<float>& out) { cycle.apply(v, out); };
  if (pull_ && !with_pull_) with_pull_.emplace().prepare(*pull_, right_side_.size(), precondition);
  mechanics::grid::conjugate_gradients(
      [&](const Field<float>& v, Field<float>& product) { multiply(clamp, v, product); },
      [&](const Field<float>& v, Field<float>& out) {
        precondition(v, out);
        if (pull_ && with_pull_->matters()) with_pull_->correct(*pull_, out);
      },
      right_side_, forcing, most_iterations,
      [&](const Field<float>& a, const Field<float>& b) { return dot(body_, a, b, n_threads_); }, n_threads_,
      kept_, found_);
  vectors_.from_field(found_.solution, scale_ * size, solution);
  return found_;
}

} // namespace springproof::msm::grid
