#include "msm/snes/moving_part.hpp"

#include <algorithm>
#include <limits>

namespace springproof::msm {

using mechanics::petsc::check;
namespace petsc = mechanics::petsc;

namespace {

MovingSprings::Entries entries_of(const Problem& problem, const LatticePart& part, const Inertia& inertia) {
  const auto on_free = [&](const auto& of_points) {
    Vector own = part.own(of_points);
    part.clear_constrained(own);
    return own;
  };
  MovingSprings::Entries entries{on_free(inertia.mass),
                                 on_free(inertia.mass_damping),
                                 {},
                                 on_free(std::vector<double>(inertia.mass.size(), 1))};
  for (const auto& [history, force] : inertia.loads)
    entries.loads.emplace_back(history, on_free(problem.on_all_points(force)));
  return entries;
}

petsc::Matrix damping_of(const LatticePart& part, const Lattice& damping) {
  const bool is_damped =
      !(damping.links.empty() && damping.volume_cells.empty() && damping.tetrahedra.empty());
  return is_damped ? part.tangent_at_rest(damping) : nullptr;
}

} // namespace

void PartInTime::residual(const Vector& at, double /*time*/, mechanics::Expect /*expect*/, Vector& residual) {
  ++work_.force_evaluations;
  residual = part_.internal_force(at);
  part_.clear_constrained(residual);
}

MovingPart::MovingPart(const Problem& problem, const LatticePart& part, PartInTime& springs,
                       const Inertia& inertia, const mechanics::EquilibriumSettings& settings)
    : MovingSprings(springs, entries_of(problem, part, inertia)), part_(part), settings_(settings),
      at_(part.make_vector()), right_(part.make_vector()), moved_(part.make_vector()),
      product_(part.make_vector()), diagonal_of_step_(part.make_vector()),
      damping_(damping_of(part, inertia.damping)),
      solver_({[this](Vec at, Vec residual) { evaluate(at, residual); },
               [this](Vec at, Mat tangent) { linearise(at, tangent); },
               [this] { return settings_.should_stop && any_rank(settings_.should_stop()); }},
              part.make_vector(), part.make_matrix(), settings.tolerance, settings.max_newton_per_step) {}

std::optional<mechanics::NonlinearProblem::Solved> MovingPart::solve_at(Vector& at, double /*load_factor*/) {
  part_.put(at_.get(), at);
  // SNES asks for a norm below its tolerance: for 0 where nothing acts.
  const double scale = moves_supports() ? std::max(terms().scale, reaction(at)) : terms().scale;
  solver_.set_tolerance(std::max(settings_.tolerance * scale, std::numeric_limits<double>::min()));
  Solved solved = solver_.solve(at_.get());
  solved.residual = relative(solved.residual, scale);
  work_.linear_iterations += solver_.last_linear_iterations();
  at = part_.own(at_.get());
  return solved;
}

double MovingPart::reaction(const Vector& at) {
  Vector force = part_.internal_force(at), on_free = force;
  part_.clear_constrained(on_free);
  force -= on_free;
  return std::sqrt(dot(force, force));
}

bool MovingPart::direction(const Vector& at, const Vector& residual, double /*load_factor*/, double forcing,
                           mechanics::Convexity /*convexity*/, Vector& step) {
  part_.put(at_.get(), at);
  linearise(at_.get(), solver_.tangent());
  part_.put(right_.get(), residual);
  constexpr int max_iterations = 500;
  const bool is_solved = solver_.solve_tangent(right_.get(), at_.get(), forcing, max_iterations);
  work_.linear_iterations += solver_.last_linear_iterations();
  step = part_.own(at_.get());
  return is_solved && std::isfinite(dot(step, step));
}

void MovingPart::add_stiffness_damping(const Vector& motion, Vector& product) {
  if (!damping_) return;
  part_.put(moved_.get(), motion); // at_ is where SNES is
  check(MatMult(damping_.get(), moved_.get(), product_.get()));
  product += part_.own(product_.get());
  part_.clear_constrained(product);
}

void MovingPart::evaluate(Vec at, Vec residual) {
  state_ = part_.own(at);
  MovingSprings::residual(state_, 0, mechanics::Expect::residual, residual_);
  residual_ = -residual_;
  part_.for_each_constrained(
      [&](PetscInt entry) { residual_[entry] = state_[entry] - terms().supports[entry]; });
  part_.put(residual, residual_);
}

void MovingPart::linearise(Vec at, Mat tangent) {
  part_.tangent_of_forces(at, tangent);
  if (damping_) check(MatAXPY(tangent, terms().damping, damping_.get(), SUBSET_NONZERO_PATTERN));
  part_.put(diagonal_of_step_.get(), diagonal());
  check(MatDiagonalSet(tangent, diagonal_of_step_.get(), ADD_VALUES));
  part_.constrain(tangent);
  if (solver_.is_direct()) ++work_.factorisations;
}

} // namespace springproof::msm
