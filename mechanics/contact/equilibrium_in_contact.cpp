#include "cases/case/error.hpp"
#include "mechanics/contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <utility>

namespace springproof::mechanics {

namespace {

constexpr int most_augmentations = 50;

void add_work(Equilibrium& to, const Equilibrium& of) {
  to.load_steps += of.load_steps;
  to.newton_iterations += of.newton_iterations;
  to.convexified_steps += of.convexified_steps;
  to.escapes += of.escapes;
  to.work.linear_iterations += of.work.linear_iterations;
  to.work.factorisations += of.work.factorisations;
  to.work.force_evaluations += of.work.force_evaluations;
}

[[noreturn]] void give_up_contact(const Contact& contact, const Contact::Misfit& misfit, int n,
                                  const Equilibrium& found, const std::string& name) {
  cases::Solution so_far = to_solution(found);
  so_far.outcome = cases::Outcome::unknown;
  if (misfit.is_change_small())
    throw cases::SolveError(
        fmt::format("{}: the friction of the tools does not settle: after {} "
                    "augmentations its forces still change by {:.3g} N, more than the "
                    "{:.3g} N that are allowed; take more load steps or a smaller friction",
                    name, n, misfit.friction, misfit.allowed_friction),
        std::move(so_far));
  throw cases::SolveError(
      fmt::format(
          "{}: the contact with the tool '{}' does not settle: after {} augmentations its forces still "
          "change by {:.3g} N, more than a thousandth of the {:.3g} N with which it presses",
          name, contact.sides()[misfit.worst].tool.name, n, misfit.change, misfit.force),
      std::move(so_far));
}

/// The equilibrium at the settings' last load, with multipliers that have settled there.
Equilibrium find_settled_equilibrium(NonlinearProblem& problem, Contact& contact,
                                     const std::function<DisplacementAt(const Vector&)>& displacement_of,
                                     const Vector& start, const std::string& name,
                                     const EquilibriumSettings& settings) {
  const Contact before = contact;
  Equilibrium found = find_equilibrium(problem, start, name, settings);
  EquilibriumSettings again = settings;
  again.from = settings.to;
  again.first_load_step = again.largest_load_step = 1;
  again.guess.reset();
  for (int n = 0;; ++n) {
    const auto misfit = contact.misfit(displacement_of(found.state), settings.to);
    if (misfit.is_small()) return found;
    if (n == most_augmentations) give_up_contact(contact, misfit, n, found, name);
    contact.augment(displacement_of(found.state), settings.to);
    Equilibrium next;
    try {
      next = find_equilibrium(problem, found.state, name, again);
    } catch (const cases::SolveError&) {
      // Friction that sets in all at once is far to go. From the step's start, where its multipliers are in
      // equilibrium, it grows with the tool's way, which can be divided.
      if (!contact.has_friction()) throw;
      contact.take_pressures_of(before);
      next = find_equilibrium(problem, start, name, settings);
    }
    add_work(next, found);
    found = std::move(next);
  }
}

} // namespace

Equilibrium find_equilibrium_in_contact(NonlinearProblem& problem, Contact* contact,
                                        const std::function<DisplacementAt(const Vector&)>& displacement_of,
                                        const Vector& start, const std::string& name,
                                        const EquilibriumSettings& settings) {
  if (!contact) return find_equilibrium(problem, start, name, settings);
  EquilibriumSettings part = settings; // a load step's with friction, else the whole way's
  part.is_way_open = [&](const Vector& from, double load_from, const Vector& to, double load_to) {
    return contact->is_way_open(displacement_of(from), load_from, displacement_of(to), load_to);
  };
  if (!contact->has_friction())
    return find_settled_equilibrium(problem, *contact, displacement_of, start, name, part);
  const int n_steps = std::max(1, static_cast<int>(std::ceil(1 / settings.largest_load_step - 1e-9)));
  const auto load = [&](int step) {
    return step == n_steps ? settings.to : settings.from + step * (settings.to - settings.from) / n_steps;
  };
  // A step may be divided where Newton's method fails.
  part.first_load_step = part.largest_load_step = 1;
  part.smallest_load_step = std::min(n_steps * settings.smallest_load_step, 1. / 16);
  part.guess.reset();
  part.may_wander = true; // nodes go one by one from sticking to slipping
  std::optional<Equilibrium> found;
  for (int step = 1; step <= n_steps; ++step) {
    part.from = load(step - 1);
    part.to = load(step);
    Equilibrium next = find_settled_equilibrium(problem, *contact, displacement_of,
                                                found ? found->state : start, name, part);
    if (found) add_work(next, *found);
    found = std::move(next);
    contact->end_step(displacement_of(found->state), part.to);
  }
  return std::move(*found);
}

} // namespace springproof::mechanics
