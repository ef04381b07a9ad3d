#include "msm/grid/moving_grid.hpp"

#include "mechanics/grid/conjugate_gradients.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace springproof::msm::grid {

namespace {

/// One number per point of the mesh on the entries of a field that are free.
Field<double> on_free_entries(const Problem& problem, const Body& body, const std::vector<double>& of_point) {
  Points points;
  for (const double value : of_point) points.push_back(Eigen::Vector3d::Constant(value));
  Field<double> field = to_field(problem, body, points);
  clear_constrained(body, field);
  return field;
}

MovingSprings::Entries entries_of(const Problem& problem, const Body& body, const Inertia& inertia) {
  MovingSprings::Entries entries{on_free_entries(problem, body, inertia.mass),
                                 on_free_entries(problem, body, inertia.mass_damping),
                                 {},
                                 on_free_entries(problem, body, std::vector<double>(inertia.mass.size(), 1))};
  for (const auto& [history, force] : inertia.loads) {
    Field<double> field = to_field(problem, body, problem.on_all_points(force));
    clear_constrained(body, field);
    entries.loads.emplace_back(history, std::move(field));
  }
  return entries;
}

CellSprings sum(CellSprings a, double factor, const CellSprings& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    a.edge[axis] += factor * b.edge[axis];
    a.face_diagonal[axis] += factor * b.face_diagonal[axis];
  }
  a.internal_diagonal += factor * b.internal_diagonal;
  a.volume += factor * b.volume;
  return a;
}

/// A body whose springs are a + factor * b.
Body stiffened(const Body& a, double factor, const Body& b) {
  Body all = a;
  if (!a.is_uniform() || !b.is_uniform()) {
    all.springs.clear();
    for_each_place(a.cells, [&](int i, int j, int k) { all.springs.push_back(a.cell(i, j, k)); });
  }
  if (all.is_uniform()) {
    all.springs.front() = sum(a.springs.front(), factor, b.springs.front());
  } else {
    auto springs = all.springs.begin();
    for_each_place(
        a.cells, [&](int i, int j, int k) { *springs = sum(*springs, factor, b.cell(i, j, k)), ++springs; });
  }
  return all;
}

class MovingGrid : public MovingSprings {
 public:
  MovingGrid(const Problem& problem, const GridProblem& grid, SpringSystem& springs, const Inertia& inertia,
             std::optional<Body> damping, int n_threads)
      : MovingSprings(springs, entries_of(problem, grid.body, inertia)), body_(grid.body),
        damping_body_(std::move(damping)), n_threads_(n_threads), springs_(body_, n_threads),
        rest_(Field<double>::Zero(3 * body_.layout.size)), damped_(rest_) {
    if (damping_body_) damping_.emplace(*damping_body_, n_threads);
  }

  void set_step(const mechanics::StepTerms& terms) override {
    MovingSprings::set_step(terms);
    linear_iterations_ = 0;
    is_prepared_ = false;
  }

  bool direction(const Vector& at, const Vector& residual, double /*load_factor*/, double forcing,
                 mechanics::Convexity convexity, Vector& step) override {
    const Clamp clamp = convexity == mechanics::Convexity::clamped ? Clamp::yes : Clamp::no;
    const double asked_for = -std::log(forcing); // of conjugate gradients
    if (!is_of_these_factors()) make_multigrid();
    if (terms().enough_linear_iterations)
      return cut_direction(at, residual, forcing, clamp, *terms().enough_linear_iterations, step);
    for (int attempt = is_slow_ ? 1 : 0; attempt < 3; ++attempt) {
      if (attempt == 2) make_multigrid(); // after points that coincide or fly off it may have learnt nonsense
      if (attempt > 0) multigrid_->linearise(at);
      solve(at, residual, forcing, clamp, max_iterations);
      const double slowness = found_.iterations / asked_for;
      if (attempt > 0) usual_slowness_ = slowness;
      is_slow_ = slowness > 2 * usual_slowness_ + 1;
      if (found_.converged || found_.met_negative_curvature) break;
    }
    if (!found_.converged) is_slow_ = true;
    has_failed_ = has_failed_ || !(found_.converged || found_.met_negative_curvature);
    step = found_.solution;
    return found_.converged;
  }

  bool has_failed() const override { return has_failed_; }

 private:
  static constexpr int max_iterations = 300;
  const Body& body_;
  std::optional<Body> damping_body_; ///< springs of beta times k
  int n_threads_;
  SpringField<double> springs_;
  std::optional<SpringField<double>> damping_;
  Field<double> rest_, damped_;
  mechanics::grid::KeptFields kept_;
  mechanics::grid::LinearSolution found_;

  std::deque<Body> bodies_;            ///< of the cycle
  std::optional<Multigrid> multigrid_; ///< of bodies_, and of these:
  double mass_factor_ = 0, damping_factor_ = 0;
  double usual_slowness_ = 0; ///< iterations over what was asked for, where the cycle was prepared
  bool is_slow_ = true;       ///< it is to be prepared
  bool has_failed_ = false;
  int linear_iterations_ = 0; ///< in this step
  bool is_prepared_ = false;  ///< in this step

  bool has_stiffness_damping() const override { return damping_.has_value(); }
  void add_stiffness_damping(const Vector& motion, Vector& product) override {
    if (!damping_) return;
    damping_->product(Clamp::no, rest_, motion, damped_);
    add(product, 1.0, damped_, n_threads_);
  }

  /// A preconditioner does not mind the rounding of a step's length.
  bool is_of_these_factors() const {
    const auto is_near = [](double a, double b) { return std::abs(a - b) <= 1e-3 * std::abs(b); };
    return multigrid_ && is_near(mass_factor_, terms().mass) && is_near(damping_factor_, terms().damping);
  }

  /// Damping by stiffness is of the body at rest, here of the body where it is.
  void make_multigrid() {
    mass_factor_ = terms().mass;
    damping_factor_ = terms().damping;
    multigrid_.reset(); // it refers to the bodies
    const Body all = damping_body_ ? stiffened(body_, damping_factor_, *damping_body_) : body_;
    bodies_ = coarsenings(all);
    multigrid_.emplace(bodies_, n_threads_, smoother_in_motion, Coarsening::rediscretised);
    multigrid_->set_diagonal(scale_of(all) * diagonal());
    is_slow_ = true;
  }

  /// As far as the step's iterations go. Conjugate gradients that are cut off, by a limit or by negative
  /// curvature, have come down the energy all the same (Steihaug 1983).
  bool cut_direction(const Vector& at, const Vector& residual, double forcing, Clamp clamp, int enough,
                     Vector& step) {
    const bool is_anew = is_slow_ && !is_prepared_; // once in a step: it takes as long as some iterations
    if (is_anew) multigrid_->linearise(at);
    is_prepared_ = is_prepared_ || is_anew;
    solve(at, residual, forcing, clamp, std::max(1, enough - linear_iterations_));
    linear_iterations_ += found_.iterations;
    const double slowness = found_.iterations / -std::log(forcing);
    if (is_anew) usual_slowness_ = slowness;
    is_slow_ = slowness > 2 * usual_slowness_ + 1;
    step = found_.solution;
    return found_.iterations > (found_.met_negative_curvature ? 1 : 0);
  }

  void solve(const Vector& at, const Vector& right_side, double forcing, Clamp clamp, int most_iterations) {
    const auto apply = [&](const Vector& v, Vector& out) {
      springs_.product(clamp, at, v, out);
      add_product(out, diagonal(), v, n_threads_);
      if (!damping_) return;
      damping_->product(Clamp::no, rest_, v, damped_);
      add(out, terms().damping, damped_, n_threads_);
    };
    mechanics::grid::conjugate_gradients(
        apply, [&](const Vector& v, Vector& out) { multigrid_->apply(v, out); }, right_side,
        forcing * norm(body_, right_side, n_threads_), most_iterations,
        [&](const Vector& a, const Vector& b) { return dot(a, b); }, n_threads_, kept_, found_);
    work_.linear_iterations += found_.iterations;
  }
};

} // namespace

std::unique_ptr<MovingSprings> make_moving_grid(const Problem& problem, const GridProblem& grid,
                                                SpringSystem& springs, const Inertia& inertia,
                                                const std::vector<CellStiffness>& damping, int n_threads) {
  std::optional<Body> damped;
  if (!damping.empty()) {
    damped = make_grid_problem(problem, damping).body;
    damped->exponents.reset(); // at rest all springs are Hooke's
    damped->constrained = grid.body.constrained;
  }
  return std::make_unique<MovingGrid>(problem, grid, springs, inertia, std::move(damped), n_threads);
}

} // namespace springproof::msm::grid
