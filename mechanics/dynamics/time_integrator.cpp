#include "mechanics/dynamics/time_integrator.hpp"

#include "cases/case/error.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/grid/krylov.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace springproof::mechanics {

namespace {
constexpr int most_settlings = 50;
}

IntegrationSettings in_real_time(int linear_iterations) {
  IntegrationSettings settings;
  settings.newton.tolerance = 1e-2;
  settings.newton.enough_newton_per_step = 2;
  settings.newton.takes_full_steps = true;
  settings.enough_linear_iterations = linear_iterations;
  return settings;
}

IntegrationSettings to_few_digits(double tolerance) {
  IntegrationSettings settings;
  settings.newton.tolerance = tolerance;
  settings.newton.takes_full_steps = true;
  settings.in_single_precision = true;
  return settings;
}

TimeIntegrator::TimeIntegrator(DynamicProblem& problem, const cases::TimeScheme& scheme, Motion start,
                               const IntegrationSettings& settings)
    : problem_(problem), scheme_(scheme), settings_(settings), newton_(problem, settings_.newton, work_),
      now_(std::move(start)) {
  for (Vector* vector : {&force_, &known_, &product_, &place_, &supports_, &now_.acceleration})
    vector->setZero(now_.displacement.size());
  next_ = now_;
  this->start();
}

void TimeIntegrator::advance(double to) {
  double step = (to - now_.time) / settings_.substeps;
  for (int halvings = 0; now_.time < to;) {
    // What is left is a whole number of steps but for rounding, which is no step of its own.
    const bool is_last = to - now_.time <= 1.5 * step;
    if (try_step(is_last ? to : now_.time + step, to)) continue;
    if (halvings++ == settings_.max_halvings) give_up(failure_);
    ++n_halvings_;
    step /= 2;
  }
}

double TimeIntegrator::kinetic_energy() {
  problem_.mass_product(now_.velocity, product_);
  return problem_.dot(now_.velocity, product_) / 2;
}

/// Finds the forces at the start and the acceleration that they give: M a = F - C v - f_int(u).
void TimeIntegrator::start() {
  if (const Contact* contact = problem_.contact()) contact->check_start();
  problem_.begin_motion(now_.displacement);
  problem_.external_force(now_.time, force_);
  scale_ = norm(force_);
  problem_.damping_product(now_.velocity, product_);
  force_ -= product_;
  StepTerms terms{0, 0, now_.displacement, force_, now_.displacement, 1};
  terms.time = now_.time;
  problem_.set_step(terms);
  const Vector imbalance = problem_.residual(now_.displacement, 0);
  const double size = norm(imbalance);
  has_loads_ = scale_ > 0;
  if (!std::isfinite(size)) give_up("the law has no forces at the start: cells are turned inside out");
  scale_ = std::max(scale_, size);
  if (!needs_acceleration(scheme_.scheme) || size == 0) return;
  constexpr double tolerance = 1e-12;
  constexpr int max_iterations = 1000; // a consistent mass takes some tens, a lumped one fewer
  const auto times_mass = [&](const Vector& of, Vector& product) { problem_.mass_product(of, product); };
  const auto as_it_is = [](const Vector& of, Vector& same) { same = of; };
  const auto dot = [&](const Vector& a, const Vector& b) { return problem_.dot(a, b); };
  auto found =
      grid::conjugate_gradients(times_mass, as_it_is, imbalance, tolerance * size, max_iterations, dot, 1);
  if (!found.converged) give_up("the mass matrix is not positive definite: the start has no acceleration");
  now_.acceleration = std::move(found.solution);
  problem_.complete(now_.acceleration);
}

/// On success now_ is at the end of the step; otherwise it is as it was.
bool TimeIntegrator::try_step(double to, double target) {
  const double step = to - now_.time;
  const auto step_before = before_ ? std::optional(now_.time - before_->time) : std::nullopt;
  const StepCoefficients c = step_coefficients(scheme_, step, step_before);
  const double time = now_.time + c.place * step;
  problem_.external_force(time, force_);
  const double load = norm(force_);
  has_loads_ = has_loads_ || load > 0;
  scale_ = std::max(scale_, load);
  add_known_forces(c);
  StepTerms terms{c.mass, c.damping, now_.displacement, force_, supports_, scale_};
  terms.duration = c.place * step;
  terms.time = time;
  if (!has_loads_ && !(problem_.largest_press() > 0)) { // velocity, supports or a tool drive the body
    predict(c, to, Guess::displacement_stays);
    terms.scale = 1;
    problem_.set_step(terms);
    problem_.residual(place_, 0, Expect::residual, residual_);
    terms.scale = std::max(scale_, norm(residual_));
    // Where a tool moves, this is the penalty times its way, which the body never bears.
    if (!problem_.contact()) scale_ = terms.scale;
  }
  terms.enough_linear_iterations = settings_.enough_linear_iterations;
  terms.in_single_precision = settings_.in_single_precision;
  terms.is_substep = to < target;
  if (!solve(terms, c, to)) return false;
  if (settings_.enough_linear_iterations &&
      work_.residual > 1) { // no solution at all: bodies fly off with it
    failure_ = "a step's linear iterations leave its forces further from balance than all loads";
    return false;
  }
  if (settings_.enough_linear_iterations && work_.residual > settings_.newton.tolerance) ++n_unfinished_;
  largest_residual_ = std::max(largest_residual_, work_.residual); // a NaN was refused
  finish_step(c, to);
  return true;
}

/// force_ += M known_acceleration + C known_velocity
void TimeIntegrator::add_known_forces(const StepCoefficients& c) {
  combine(c.known_acceleration);
  problem_.mass_product(known_, product_);
  force_ += product_;
  if (c.known_velocity.is_none()) return;
  combine(c.known_velocity);
  problem_.damping_product(known_, product_);
  force_ += product_;
}

void TimeIntegrator::combine(const KnownMotion& known) {
  known_ = known.velocity * now_.velocity;
  if (known.acceleration != 0) known_ += known.acceleration * now_.acceleration;
  if (!before_) return;
  known_ += known.displacement_before * (before_->displacement - now_.displacement);
  known_ += known.velocity_before * before_->velocity;
}

/// Solves by Newton's method from where the motion leads, or else from where the step begins.
bool TimeIntegrator::solve(const StepTerms& terms, const StepCoefficients& c, double to) {
  problem_.set_step(terms);
  const int iterations_before = std::exchange(work_.newton_iterations, 0); // limits are on each step
  bool is_solved = false;
  try {
    for (const Guess guess :
         {is_smooth_ ? Guess::acceleration_stays : Guess::velocity_stays, Guess::displacement_stays}) {
      predict(c, to, guess);
      if (problem_.moves_supports()) take_along();
      if (guess != Guess::displacement_stays) problem_.follow_tools(now_.time, now_.displacement, place_);
      is_solved = find_place();
      if (is_solved) break;
    }
  } catch (const Newton::Stopped& stopped) {
    work_.newton_iterations += iterations_before;
    give_up(stopped.reason);
  }
  work_.newton_iterations += iterations_before;
  return is_solved;
}

/// Solves from place_, and again while what the equation holds does not agree with the solution.
bool TimeIntegrator::find_place() {
  for (int n = 0; n <= most_settlings; ++n) {
    if (!newton_.solve(place_, 0, Convexity::clamped)) {
      failure_ = newton_.failure();
      return false;
    }
    if (!problem_.settle(place_)) continue;
    if (problem_.is_way_open(now_.time, now_.displacement, place_)) return true;
    failure_ = "a node goes through a tool in one step";
    return false;
  }
  failure_ = "the friction of the tools does not settle";
  return false;
}

/// Sets guess_, and place_ and supports_ with the supports where the step holds them.
void TimeIntegrator::predict(const StepCoefficients& c, double to, Guess guess) {
  if (guess == Guess::acceleration_stays) {
    combine(c.known_acceleration);
    guess_ = now_.displacement + (now_.acceleration + known_) / c.mass;
  } else {
    const double way = guess == Guess::velocity_stays ? c.place * (to - now_.time) : 0;
    guess_ = now_.displacement + way * now_.velocity;
  }
  if (c.place == 1) {
    place_ = guess_;
    problem_.supports_at(to, place_);
    supports_ = place_;
    return;
  }
  place_ = now_.displacement + (guess_ - now_.displacement) / c.place;
  problem_.supports_at(to, place_);
  supports_ = now_.displacement + c.place * (place_ - now_.displacement);
  place_ = supports_;
}

/// Supports that are not where the guess has them take the body along as far as the tangent knows: moved
/// alone, they would turn the cells next to them inside out.
void TimeIntegrator::take_along() {
  product_ = place_ - guess_;
  const double largest = problem_.largest(product_);
  if (!(largest > 1e-12 * problem_.largest(place_))) return;
  constexpr double small = 1e-7; // mm: differences of forces then keep half of their digits
  problem_.residual(guess_, 0, Expect::residual, residual_);
  guess_ += (small / largest) * product_;
  problem_.residual(guess_, 0, Expect::residual, product_);
  product_ = (largest / small) * (product_ - residual_);
  if (problem_.direction(guess_, product_, 0, 1e-3, Convexity::exact, step_)) place_ += step_;
}

void TimeIntegrator::finish_step(const StepCoefficients& c, double to) {
  next_.time = to;
  next_.displacement = place_;
  place_ -= now_.displacement; // w - u0
  if (c.place != 1) next_.displacement = now_.displacement + (1 / c.place) * place_;
  problem_.supports_at(to, next_.displacement);
  if (c.known_velocity.is_none() && c.place == 1) {
    next_.velocity = c.damping * place_;
  } else {
    combine(c.known_velocity);
    next_.velocity = now_.velocity + (c.damping * place_ - known_ - now_.velocity) / c.place;
  }
  combine(c.known_acceleration);
  next_.acceleration =
      now_.acceleration + (1 / c.place_acceleration) * (c.mass * place_ - known_ - now_.acceleration);
  step_ = next_.acceleration - now_.acceleration;
  is_smooth_ = norm(step_) < norm(next_.acceleration);
  problem_.end_step(next_.displacement, to - now_.time);
  if (scheme_.scheme == cases::Scheme::bdf2) {
    if (!before_) before_ = now_;
    std::swap(*before_, now_);
  }
  std::swap(now_, next_);
}

double TimeIntegrator::norm(const Vector& of) const {
  return std::sqrt(problem_.dot(of, of));
}

void TimeIntegrator::give_up(const std::string& reason) {
  std::ostringstream message;
  message << "motion, after " << now_.time << " s: " << reason;
  work_.n_unknowns = problem_.n_unknowns();
  work_.work = problem_.work();
  throw cases::SolveError(message.str(), to_solution(work_));
}

} // namespace springproof::mechanics
