#include "msm/grid/moving_grid.hpp"

#include "mechanics/grid/krylov.hpp"
#include "msm/grid/held_factor.hpp"
#include "msm/grid/preconditioner_schedule.hpp"
#include "msm/grid/real_time_solver.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace springproof::msm::grid {

namespace {

using cases::index;

CellSprings sum(CellSprings a, double factor, const CellSprings& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    a.edge[axis] += factor * b.edge[axis];
    a.face_diagonal[axis] += factor * b.face_diagonal[axis];
    a.midline[axis] += factor * b.midline[axis];
  }
  a.internal_diagonal += factor * b.internal_diagonal;
  a.volume += factor * b.volume;
  return a;
}

/// A body whose springs are a + factor * b.
Body stiffened(const Body& a, double factor, const Body& b) {
  Body all = a;
  all.springs.clear();
  for_each_place(
      a.is_uniform() && b.is_uniform() ? std::array<int, 3>{1, 1, 1} : a.cells,
      [&](int i, int j, int k) { all.springs.push_back(sum(a.cell(i, j, k), factor, b.cell(i, j, k))); });
  return all;
}

class MovingGrid : public MovingSprings {
 public:
  MovingGrid(const Problem& problem, const GridProblem& grid, const NodeVectors& vectors, GridSystem& statics,
             const Inertia& inertia, std::optional<Body> damping, std::optional<CellMasses> masses,
             int n_threads)
      : MovingSprings(statics, entries_of(problem, inertia,
                                          [&](const Points& points) {
                                            Field<double> field = to_field(problem, grid.body, points);
                                            clear_constrained(grid.body, field);
                                            return vectors.from_field(field);
                                          })),
        grid_(grid), body_(grid.body), vectors_(vectors), statics_(statics),
        damping_body_(std::move(damping)), cell_masses_(std::move(masses)), n_threads_(n_threads) {
    if (damping_body_) {
      damping_.emplace(*damping_body_, n_threads);
      rest_.setZero(3 * body_.layout.size);
      joined_.setZero(vectors.size());
    }
    if (cell_masses_) masses_.emplace(body_, *cell_masses_, n_threads);
    if (grid.n_unknowns <= most_held && !body_.part) factor_.emplace(body_, vectors);
    for (const std::ptrdiff_t entry : body_.constrained)
      if (const Eigen::Index in_vector = vectors.entry(entry); in_vector >= 0)
        constrained_.emplace_back(in_vector, entry);
  }

  void supports_at(double time, Vector& displacement) const override {
    if (!grid_.supports) return;
    const Field<double>& there = grid_.supports(time);
    for (const auto& [in_vector, in_field] : constrained_) displacement[in_vector] = there[in_field];
  }
  int n_inverted(const Vector& at) override { return statics_.n_inverted(vectors_.to_field(at, at_)); }

  void set_step(const mechanics::StepTerms& terms) override {
    MovingSprings::set_step(terms);
    linear_iterations_ = 0;
    is_prepared_ = is_set_ = false;
    schedule_.begin_step(terms);
  }

  bool direction(const Vector& at, const Vector& residual, double /*load_factor*/, double forcing,
                 mechanics::Convexity convexity, Vector& step) override {
    const Clamp clamp = convexity == mechanics::Convexity::clamped ? Clamp::yes : Clamp::no;
    const auto enough = terms().enough_linear_iterations;
    if (has_tools()) see_tools(at, clamp);
    const bool is_done = (has_factor(at) && goes_by_factor(at, residual, forcing, clamp)) ||
                         (enough ? goes_by_cut_cycles(at, residual, forcing, clamp)
                                 : goes_by_cycles(at, residual, forcing, clamp));
    step = found_.solution;
    // Conjugate gradients that are cut off, by a limit or by negative curvature, have come down the energy
    // all the same (Steihaug 1983).
    return enough ? found_.iterations > (found_.met_negative_curvature ? 1 : 0) : is_done;
  }

  bool has_failed() const override { return has_failed_; }

 protected:
  void has_pull_changed() override {
    factor_with_pull_.reset();
    cycle_with_pull_.reset();
    if (real_time_) real_time_->set_pull(pull());
  }

 private:
  static constexpr int max_iterations = 300;
  /// Unknowns up to which a factor takes less time than a cycle, and not too long to make.
  static constexpr std::size_t most_held = 10'000;
  static constexpr int most_with_factor = 20; ///< iterations; healthy motions take less than 10
  const GridProblem& grid_;
  const Body& body_;
  const NodeVectors& vectors_;
  GridSystem& statics_;
  std::vector<std::pair<Eigen::Index, std::ptrdiff_t>> constrained_; ///< entries, in a vector and in a field
  std::optional<Body> damping_body_;                                 ///< springs of beta times k
  std::optional<CellMasses> cell_masses_;                            ///< none: all masses are lumped
  int n_threads_;
  std::optional<SpringField<double>> damping_;
  std::optional<ConsistentMasses<double>> masses_;
  Field<double> rest_;
  Vector joined_;               ///< room for what inertia adds
  Field<double> at_, in_, out_; ///< room for vectors as fields
  mechanics::grid::KeptFields<double> kept_;
  mechanics::grid::LinearSolution found_;
  int linear_iterations_ = 0; ///< count in this step

  std::optional<HeldFactor> factor_; ///< none for large bodies
  FactorSchedule schedule_;

  std::optional<SpringLevels> multigrid_; ///< made with these:
  Factors of_multigrid_;
  std::optional<ConsistentMasses<float>> masses_of_cycle_;
  std::optional<RealTimeSolver> real_time_; ///< made anew with the cycle
  bool is_set_ = false;                     ///< real_time_ knows this step
  CycleSpeed speed_;
  bool has_failed_ = false;
  bool is_prepared_ = false; ///< the cycle was, in this step

  std::vector<PressedNode> pressed_;             ///< by tools, where the last direction begins
  std::vector<Eigen::Index> pressed_in_cycle_{}; ///< those that the cycle knows, by entries of a field

  /// Preconditioners with what pulls, where they are known for it.
  std::optional<WithPull<double>> factor_with_pull_, cycle_with_pull_;

  void spring_residual(const Vector& at, mechanics::Expect expect, Vector& residual) override {
    const Field<double>& place = vectors_.to_field(at, at_);
    vectors_.from_field([&](Field<double>& force) { statics_.residual(place, 0, expect, force); }, out_,
                        residual);
  }
  double spring_energy(const Vector& at) override { return statics_.energy(vectors_.to_field(at, at_), 0); }
  double reaction(const Vector& at) override { return statics_.reaction(vectors_.to_field(at, at_)); }

  bool joins_nodes() const override { return damping_ || masses_; }
  void add_joined(double mass, double damping, const Vector& motion, Vector& product) override {
    const Field<double>& v = vectors_.to_field(motion, in_);
    if (masses_ && vectors_.are_fields()) {
      masses_->add_product(mass, damping, v, product);
    } else if (masses_) {
      vectors_.from_field(
          [&](Field<double>& force) {
            force.setZero(v.size());
            masses_->add_product(mass, damping, v, force);
          },
          out_, joined_);
      add(product, 1.0, joined_, n_threads_);
    }
    add_damping(damping, v, product);
  }
  /// product += factor * damping's tangent at rest * direction
  void add_damping(double factor, const Field<double>& direction, Vector& product) {
    if (!damping_ || factor == 0) return;
    // at rest nothing is there to clamp, and the clamped product takes two thirds of the time
    vectors_.from_field([&](Field<double>& force) { damping_->product(Clamp::yes, rest_, direction, force); },
                        out_, joined_);
    add(product, factor, joined_, n_threads_);
  }

  /// product = (tangent + mass + damping of the step) direction, without what pulls
  /// @param at  as a field
  void multiply(const Field<double>& at, Clamp clamp, const Vector& direction, Vector& product) {
    const Field<double>& v = vectors_.to_field(direction, in_);
    vectors_.from_field(
        [&](Field<double>& force) {
          statics_.springs().product(clamp, at, v, force);
          if (masses_) masses_->add_product(terms().mass, terms().damping, v, force);
        },
        out_, product);
    add_product(product, diagonal(), direction, n_threads_);
    add_damping(terms().damping, v, product);
    for (const PressedNode& node : pressed_)
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          if (const Eigen::Index row = node.entries[index(r)], column = node.entries[index(c)];
              row >= 0 && column >= 0)
            product[row] += node.tangent(r, c) * direction[column];
  }

  /// Sets what tools press, in a cycle that knows other nodes too.
  void see_tools(const Vector& at, Clamp clamp) {
    pressed_ = pressed_nodes(at, clamp);
    std::vector<Eigen::Index> nodes;
    for (const PressedNode& node : pressed_) nodes.push_back(x_in_field(node));
    if (multigrid_ && nodes != pressed_in_cycle_) {
      pressed_in_cycle_ = std::move(nodes);
      multigrid_->set_blocks(blocks(multigrid_->scale()));
      has_cycle_changed();
    }
    if (real_time_) real_time_->set_blocks(blocks(multigrid_->scale()));
  }
  /// The entry of a field for x of a pressed node, of which a component at least is free, or -1.
  std::ptrdiff_t x_in_field(const PressedNode& node) const {
    for (int c = 0; c < 3; ++c)
      if (const Eigen::Index entry = node.entries[index(c)]; entry >= 0)
        return vectors_.in_field(entry) - c * body_.layout.size;
    return -1;
  }
  std::vector<NodeBlock> blocks(double scale) const {
    std::vector<NodeBlock> all;
    for (const PressedNode& node : pressed_) {
      Eigen::Matrix3d block = scale * node.tangent;
      for (int c = 0; c < 3; ++c)
        if (node.entries[index(c)] < 0) {
          block.row(c).setZero();
          block.col(c).setZero();
        }
      if (const std::ptrdiff_t x = x_in_field(node); x >= 0) all.push_back({x, block.cast<float>()});
    }
    return all;
  }

  /// @param precondition  approximate inverse of multiply() times `scale`
  /// @param with_pull     the same with what pulls, where it is known
  void solve(const Vector& at, const Vector& right_side, double forcing, Clamp clamp, int most_iterations,
             double scale, const std::function<void(const Vector&, Vector&)>& precondition,
             std::optional<WithPull<double>>& with_pull) {
    if (pull() && !with_pull)
      with_pull.emplace().prepare({pull()->entries(), scale * pull()->stiffness()}, at.size(), precondition);
    const Field<double>& place = vectors_.to_field(at, at_);
    mechanics::grid::conjugate_gradients(
        [&](const Vector& v, Vector& product) {
          multiply(place, clamp, v, product);
          if (pull()) pull()->add_product(v, product);
        },
        [&](const Vector& v, Vector& out) {
          precondition(v, out);
          if (pull() && with_pull->matters()) with_pull->correct(*pull(), out);
        },
        right_side, forcing * norm(body_, right_side, n_threads_), most_iterations,
        [&](const Vector& a, const Vector& b) { return dot(a, b); }, n_threads_, kept_, found_);
    count_iterations();
  }

  void count_iterations() {
    work_.linear_iterations += found_.iterations;
    linear_iterations_ += found_.iterations;
  }

  /// Returns what is left of the step's limit, or the given number if it has none.
  int most_iterations(int without_limit) const {
    const auto enough = terms().enough_linear_iterations;
    return enough ? std::max(1, *enough - linear_iterations_) : without_limit;
  }

  /// Whether there is a factor for this step; makes one that is due.
  bool has_factor(const Vector& at) {
    if (has_tools()) return false; // whom they press changes
    if (factor_ && schedule_.is_due()) {
      schedule_.make();
      factor_with_pull_.reset();
      const Field<double>& place = vectors_.to_field(at, at_);
      if (!factor_->factorise(
              [&](const Vector& v, Vector& product) { multiply(place, Clamp::yes, v, product); }))
        factor_.reset(); // lost in rounding
    }
    return factor_ && schedule_.serves();
  }

  bool goes_by_factor(const Vector& at, const Vector& residual, double forcing, Clamp clamp) {
    solve(
        at, residual, forcing, clamp, most_iterations(most_with_factor), 1,
        [&](const Vector& v, Vector& out) { factor_->apply(v, out); }, factor_with_pull_);
    const bool is_done =
        found_.converged || found_.met_negative_curvature || terms().enough_linear_iterations.has_value();
    if (!is_done) schedule_.pass();
    return is_done;
  }

  /// Makes the cycle. Damping by stiffness belongs to the body at rest; the cycle has that of the moved body.
  void make_multigrid() {
    of_multigrid_ = schedule_.step();
    multigrid_.emplace(damping_body_ ? stiffened(body_, of_multigrid_.damping, *damping_body_) : body_,
                       n_threads_, smoother_in_motion);
    SpringLevels::Operator joined;
    if (cell_masses_) {
      masses_of_cycle_.emplace(body_, *cell_masses_, n_threads_);
      joined = [this, scale = multigrid_->scale()](const Field<float>& direction, Field<float>& product) {
        masses_of_cycle_->add_product(scale * of_multigrid_.mass, scale * of_multigrid_.damping, direction,
                                      product);
      };
    }
    multigrid_->set_diagonal(multigrid_->scale() * vectors_.to_field(diagonal(), in_), std::move(joined));
    speed_.forget();
    real_time_.reset();
    is_set_ = false;
  }

  void linearise(const Vector& at) {
    if (has_tools()) {
      pressed_in_cycle_.clear();
      for (const PressedNode& node : pressed_) pressed_in_cycle_.push_back(x_in_field(node));
      multigrid_->set_blocks(blocks(multigrid_->scale()));
    }
    multigrid_->linearise(vectors_.to_field(at, at_));
    has_cycle_changed();
  }
  void has_cycle_changed() {
    if (cycle_with_pull_ && cycle_with_pull_->matters()) cycle_with_pull_.reset();
    if (real_time_) real_time_->has_cycle_changed();
  }

  void solve_by_cycles(const Vector& at, const Vector& residual, double forcing, Clamp clamp) {
    const auto cycle = [&](const Vector& v, Vector& out) {
      const Field<double>& right_side = vectors_.to_field(v, in_);
      vectors_.from_field([&](Field<double>& field) { multigrid_->apply(right_side, field); }, out_, out);
    };
    solve(at, residual, forcing, clamp, max_iterations, multigrid_->scale(), cycle, cycle_with_pull_);
  }

  /// Solves as far as the step's iterations go.
  bool goes_by_cut_cycles(const Vector& at, const Vector& residual, double forcing, Clamp clamp) {
    if (!multigrid_ || !of_multigrid_.are_of(terms())) make_multigrid();
    const bool is_anew =
        speed_.is_slow() && !is_prepared_; // once in a step: it takes as long as some iterations
    if (is_anew) linearise(at);
    is_prepared_ = is_prepared_ || is_anew;
    solve_in_real_time(at, residual, forcing, clamp);
    speed_.measure(found_.iterations, forcing, is_anew);
    return found_.converged;
  }

  void solve_in_real_time(const Vector& at, const Vector& residual, double forcing, Clamp clamp) {
    if (!real_time_) {
      real_time_.emplace(body_, vectors_, multigrid_->scale(), damping_body_,
                         cell_masses_ ? &*cell_masses_ : nullptr, n_threads_);
      real_time_->set_pull(pull());
      real_time_->set_blocks(blocks(multigrid_->scale()));
    }
    if (!is_set_) real_time_->set_step(diagonal(), terms().mass, terms().damping);
    is_set_ = true;
    const auto& found = real_time_->solve(at, clamp, residual, norm(body_, residual, n_threads_), forcing,
                                          most_iterations(max_iterations), *multigrid_, found_.solution);
    found_.iterations = found.iterations;
    found_.converged = found.converged;
    found_.met_negative_curvature = found.met_negative_curvature;
    count_iterations();
  }

  /// Solves to the end, with a cycle that is prepared anew where it has become slow.
  bool goes_by_cycles(const Vector& at, const Vector& residual, double forcing, Clamp clamp) {
    if (!multigrid_ || !of_multigrid_.are_of(terms())) make_multigrid();
    for (int attempt = speed_.is_slow() ? 1 : 0; attempt < 3; ++attempt) {
      if (attempt == 2) make_multigrid(); // after points that coincide or fly off it may have learnt nonsense
      if (attempt > 0) linearise(at);
      if (terms().in_single_precision)
        solve_in_real_time(at, residual, forcing, clamp);
      else
        solve_by_cycles(at, residual, forcing, clamp);
      speed_.measure(found_.iterations, forcing, attempt > 0);
      if (found_.converged || found_.met_negative_curvature) break;
    }
    if (!found_.converged) speed_.forget();
    has_failed_ = has_failed_ || !(found_.converged || found_.met_negative_curvature);
    return found_.converged;
  }
};

} // namespace

std::unique_ptr<MovingSprings> make_moving_grid(const Problem& problem, const GridProblem& grid,
                                                const NodeVectors& vectors, GridSystem& statics,
                                                const Inertia& inertia,
                                                const std::vector<CellStiffness>& damping, int n_threads) {
  std::optional<Body> damped;
  if (!damping.empty()) {
    damped = make_grid_problem(problem, damping).body;
    damped->exponents.reset(); // at rest all springs are Hooke's
    damped->constrained = grid.body.constrained;
  }
  std::optional<CellMasses> masses;
  if (!inertia.cell_mass.empty()) masses.emplace(*problem.mesh.grid, grid.body, inertia);
  return std::make_unique<MovingGrid>(problem, grid, vectors, statics, inertia, std::move(damped),
                                      std::move(masses), n_threads);
}

} // namespace springproof::msm::grid
