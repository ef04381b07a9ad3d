#include "fem_reference/grid/grid_equations.hpp"

#include "cases/mesh/mesh.hpp"
#include "mechanics/grid/krylov.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace springproof::fem_reference::grid {

namespace {

using cases::index;

/// Smoothers. The sheared cube of 40^3 cells takes 15 iterations in all, 19 with a polynomial of degree 2.
/// Quadratic elements gain nothing from the better one, because trilinear ones only approximate them.
constexpr mechanics::grid::Chebyshev linear_smoother{3, 12}, quadratic_smoother{2, 6};
constexpr int max_linear_iterations = 500;
/// Largest share of a residual that is left by an iteration that gains much.
constexpr double much_gained = 0.2;
/// Limits on GMRES iterations. It keeps two vectors for each iteration until it restarts.
constexpr int max_unsymmetric_iterations = 400, max_indefinite_iterations = 80;
constexpr int restart_of(std::ptrdiff_t n) {
  return n < 1000000 ? 80 : 30;
}

} // namespace

GridEquations::GridEquations(const Body& body, const Supported& supported, int n_threads,
                             QuadraticElements* quadratic, double volume_tolerance)
    : ElementEquations(body.internal != Internal::none, body.law == Law::small_strain), body_(body),
      supported_(supported), space_(body.space(n_threads)), quadratic_(quadratic),
      multigrid_(body, n_threads, quadratic ? quadratic_smoother : linear_smoother),
      volume_tolerance_(volume_tolerance) {
  load_norm_ = norm(space_, supported.load);
}

/// Adds the internal force, and sets volume_mismatch_, bubble_imbalance_ and condensed_.  @return whether the
/// state is admissible
bool GridEquations::add_force(const Vector& at, Field<double>& force) {
  volume_mismatch_ = 0;
  bubble_imbalance_.assign(index(space_.slab.n_planes()), 0.); // above the last plane is no layer
  if (quadratic_) {
    const bool is_valid = quadratic_->add_force(at.data(), force.data(), nullptr);
    condensed_ = force;
    return is_valid;
  }
  condensed_.setZero(has_internal_ ? n_displacements() : 0);
  const ForceFields fields{at.data(), at.data() + n_displacements(), force.data(),
                           has_internal_ ? condensed_.data() : nullptr, nullptr};
  const Cells view = body_.view();
  const Checks checks = check_layers(body_.slab, space_.n_threads, [&](int k, Checks& of_layer) {
    kernels().force(view, fields, k, of_layer);
    bubble_imbalance_[index(k)] = of_layer.bubble_imbalance;
  });
  volume_mismatch_ = checks.volume_mismatch;
  if (!has_internal_) condensed_ = force;
  return checks.valid;
}

/// Adds the inertia and damping of a step in time to the force, and to that with the imbalance of the cells'
/// unknowns.
void GridEquations::add_inertia(const Vector& at, Field<double>& force) {
  Field<double> way = at.head(n_displacements()) - step_->origin.head(n_displacements());
  space_.slab.update_ghosts(space_.layout, way.data());
  Field<double> added = Field<double>::Zero(n_displacements());
  inertia_->add_step_product(way, added);
  force += added;
  condensed_ += added;
}

void GridEquations::set_in_motion(const cases::Scene& scene, const Places& places) {
  inertia_ = std::make_unique<Inertia>(scene, places, space_.n_threads);
  set_loads(scene, [&](const cases::Scene& alone) {
    Vector force = rest();
    force.head(n_displacements()) = make_load(alone, false, places);
    return force;
  });
}

void GridEquations::supports_at(double time, Vector& displacement) const {
  if (!supported_.prescribed_at) return;
  const std::vector<double> values = supported_.prescribed_at(time);
  for (std::size_t m = 0; m < values.size(); ++m) displacement[supported_.moved[m]] = values[m];
}

/// Multiplies on free degrees of freedom; the product is 0 elsewhere.
void GridEquations::multiply(const Inertia::Factors& factors, const Vector& motion, Vector& product) {
  motion_ = motion.head(n_displacements());
  space_.slab.update_ghosts(space_.layout, motion_.data());
  product_.setZero(motion_.size());
  inertia_->add_product(factors, motion_, product_);
  product.setZero(motion.size());
  product.head(product_.size()) = product_.cwiseProduct(body_.free.cast<double>());
}

void GridEquations::set_step(const mechanics::StepTerms& terms) {
  step_.emplace(terms);
  if (!std::exchange(begins_step_, true)) carries_tangent_ = std::exchange(is_easy_, true);
  if (inertia_->set_step({terms.mass, terms.damping})) has_tangent_ = false;
}

void GridEquations::linearise(const Vector& at) {
  multigrid_.linearise(at.data(), at.data() + n_displacements(), inertia_.get());
  if (quadratic_) quadratic_->linearise(at.data());
}

void GridEquations::product(Field<double>& field, Field<double>& product) const {
  if (!quadratic_) return multigrid_.product(field, product);
  quadratic_->product(field, product);
  product.array() *= body_.free.cast<double>().array();
}

void GridEquations::residual(const Vector& at, double load_factor, mechanics::Expect, Vector& residual) {
  ++work_.force_evaluations;
  gap_.clear();
  largest_gap_ = 0;
  if (supported_.prescribed) {
    if (!step_) gap_ = supported_.prescribed(load_factor);
    gap_.resize(supported_.moved.size());
    for (std::size_t i = 0; i < gap_.size(); ++i) {
      if (step_) gap_[i] = step_->supports[supported_.moved[i]];
      gap_[i] -= at[supported_.moved[i]];
      largest_gap_ = std::max(largest_gap_, std::abs(gap_[i]));
    }
  }
  Field<double> force = Field<double>::Zero(n_displacements());
  is_valid_ = space_.slab.largest(add_force(at, force) ? 0 : 1) == 0;
  residual.setConstant(at.size(), is_valid_ ? 0 : std::numeric_limits<double>::quiet_NaN());
  if (!is_valid_) return;
  volume_mismatch_ = space_.slab.largest(volume_mismatch_);
  largest_gap_ = space_.slab.largest(largest_gap_);
  if (step_) add_inertia(at, force);
  Field<double> reaction = force;
  const auto load = [&](Eigen::Index i) {
    return step_ ? step_->force[i] : load_factor * supported_.load[i];
  };
  for (Eigen::Index i = 0; i < n_displacements(); ++i) {
    const bool is_free = body_.free[i] > 0;
    residual[i] = is_free ? load(i) - force[i] : 0;
    condensed_[i] = is_free ? load(i) - condensed_[i] : 0;
    if (is_free) reaction[i] = 0;
  }
  reaction_ = norm(space_, reaction);
}

GridEquations::Size GridEquations::size(const Vector& residual, const Vector&) {
  if (!is_valid_) return {std::numeric_limits<double>::quiet_NaN(), false};
  double squared = dot(residual, residual);
  if (body_.internal == Internal::bubbles) {
    const auto [begin, end] = space_.slab.computed();
    const auto of_layers = bubble_imbalance_.begin();
    squared += space_.slab.total({of_layers + begin, of_layers + end});
  }
  const double imbalance = std::sqrt(squared);
  return {imbalance == 0 ? 0 : imbalance / scale(bool(supported_.prescribed), reaction_),
          volume_mismatch_ <= volume_tolerance_ && largest_gap_ <= 1e-12};
}

/// Close to the solution the last tangent serves as long as each step gains much. Steps in time begin with
/// the tangent that the last one ended with.
bool GridEquations::may_keep_tangent(double norm) const {
  if (!has_tangent_) return false;
  if (is_linear_) return true;
  if (begins_step_) return carries_tangent_;
  return (step_ || norm <= 0.01 * scale(bool(supported_.prescribed), reaction_)) &&
         norm <= much_gained * norm_before_;
}

std::optional<Field<double>> GridEquations::solve(const Field<double>& right_side, double target) {
  const auto times = [&](Field<double>& x, Field<double>& y) { product(x, y); };
  const auto precondition = [&](const Field<double>& x, Field<double>& y) { multigrid_.apply(x, y); };
  const auto dot = [&](const Field<double>& a, const Field<double>& b) { return grid::dot(space_, a, b); };
  const std::ptrdiff_t n_unknowns = 3 * space_.slab.n_planes_of_grid() * space_.layout.plane;
  const auto minimise = [&](int max_iterations) {
    auto found =
        mechanics::grid::generalised_minimal_residual(times, precondition, right_side, target, max_iterations,
                                                      restart_of(n_unknowns), dot, space_.n_threads);
    work_.linear_iterations += found.iterations;
    return found;
  };
  if (!with_law(body_.law, [](auto law) { return decltype(law)::Moduli::is_symmetric; })) {
    auto found = minimise(max_unsymmetric_iterations);
    return found.converged ? std::optional(std::move(found.solution)) : std::nullopt;
  }
  auto found = mechanics::grid::conjugate_gradients(times, precondition, right_side, target,
                                                    max_linear_iterations, dot, space_.n_threads);
  work_.linear_iterations += found.iterations;
  if (!found.converged && found.met_negative_curvature) found = minimise(max_indefinite_iterations);
  if (!found.converged) return std::nullopt;
  return std::move(found.solution);
}

bool GridEquations::direction(const Vector& at, const Vector&, double, double forcing, mechanics::Convexity,
                              Vector& step) {
  const double imbalance = norm(space_, condensed_);
  has_failed_ = !std::isfinite(imbalance); // the bubbles of some cell have a singular stiffness
  if (has_failed_) return false;
  if (!may_keep_tangent(imbalance)) {
    linearise(at);
  } else if (!is_linear_) {
    forcing = std::max(forcing, 0.01); // a tangent of another state gains no more than that a step
  }
  has_tangent_ = true;
  is_easy_ = is_easy_ && (begins_step_ || imbalance <= much_gained * norm_before_);
  begins_step_ = false;
  norm_before_ = imbalance;
  Field<double> right_side = condensed_;
  if (largest_gap_ > 0) {
    Field<double> gap = Field<double>::Zero(n_displacements()), pull = gap;
    for (std::size_t i = 0; i < gap_.size(); ++i) gap[supported_.moved[i]] = gap_[i];
    product(gap, pull);
    add(right_side, -1.0, pull, space_.n_threads);
  }
  const auto solution = solve(right_side, forcing * norm(space_, right_side));
  has_failed_ = !solution;
  if (!solution) {
    forget_tangent();
    return false;
  }
  step.setZero(at.size());
  step.head(n_displacements()) = *solution;
  for (std::size_t i = 0; i < gap_.size(); ++i) step[supported_.moved[i]] = gap_[i];
  space_.slab.update_ghosts(space_.layout, step.data());
  if (has_internal_) {
    const Cells view = body_.view();
    const ForceFields fields{at.data(), at.data() + n_displacements(), nullptr, nullptr, nullptr};
    for_each_plane({0, body_.cells[2]}, space_.n_threads, [&](int k) {
      kernels().internal_change(view, fields, step.data(), step.data() + n_displacements(), k);
    });
  }
  return true;
}

double GridEquations::dot(const Vector& left, const Vector& right) const {
  const Field<double> a = left.head(n_displacements()), b = right.head(n_displacements());
  return grid::dot(space_, a, b);
}

std::size_t GridEquations::n_unknowns() const {
  const Field<double> free = body_.free.cast<double>();
  return static_cast<std::size_t>(grid::dot(space_, free, free)); // ones and zeros: exact
}

/// Runs of this rank's own entries: each component's planes of nodes, and the layers of cells. Nothing where
/// vectors are whole.
std::vector<GridEquations::Run> GridEquations::runs() const {
  if (!space_.slab.is_shared()) return {};
  const Layout &here = body_.layout, whole = make_layout(body_.cells_of_grid());
  const int first = space_.slab.first_of_grid();
  std::vector<Run> runs;
  Eigen::Index end = 0; // end of the run before, in whole vectors
  const auto add = [&](Eigen::Index from, Eigen::Index n, Eigen::Index in_whole) {
    runs.push_back({from, n, in_whole - end});
    end = in_whole + n;
  };
  for (Eigen::Index c = 0; c < 3; ++c)
    add(c * here.size + here.lead, here.plane * here.nodes[2], c * whole.size + whole.at(0, 0, first));
  for (Eigen::Index f = 0; f < n_fields(body_.internal); ++f)
    add(3 * here.size + f * here.n_cell_entries(), here.n_cell_entries(),
        3 * whole.size + f * whole.n_cell_entries() + whole.cell(0, 0, first));
  return runs;
}

std::optional<bool> GridEquations::is_stable(const Vector&) {
  if (!has_tangent_) return std::nullopt;
  negative_eigenvalues_ = count_negative_eigenvalues(
      body_, [&](Field<double>& x, Field<double>& y) { product(x, y); }, multigrid_, work_.linear_iterations);
  return *negative_eigenvalues_ == 0;
}

std::vector<double> GridEquations::cell_volumes(const Vector& at) const {
  const Layout& layout = quadratic_ ? quadratic_->cells().layout : body_.layout;
  std::vector<double> volumes(index(layout.n_cell_entries() + 16));
  if (quadratic_) {
    quadratic_->add_force(at.data(), nullptr, volumes.data());
    return volumes;
  }
  const ForceFields fields{at.data(), at.data() + n_displacements(), nullptr, nullptr, volumes.data()};
  const Cells view = body_.view();
  check_layers(body_.slab, space_.n_threads,
               [&](int k, Checks& checks) { kernels().force(view, fields, k, checks); });
  return volumes;
}

} // namespace springproof::fem_reference::grid
