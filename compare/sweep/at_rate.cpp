#include "compare/sweep/at_rate.hpp"

#include "compare/client/judge.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/sweep/stepped_body.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace springproof::compare {

namespace {

using Cells = std::array<int, 3>;

constexpr double part_for_designs = 0.3; ///< part of the budget for designs and first frames
constexpr double kept_designs = 0.25;    ///< part of those with springs in equilibrium

struct Candidate {
  std::size_t body;
  Steps steps;
  double seconds_a_frame;
  VariantRun run{};
  std::optional<double> error{};
};

/// Whether other cells of the body can be made, and displacements be interpolated between them.
bool has_levels(const cases::Case& definition) {
  return std::holds_alternative<cases::Box>(definition.body) && definition.removed.empty();
}

/// The same method with no more iterations and no more substeps.
bool is_less_work(const Steps& one, const Steps& than) {
  return std::visit(
      [&](const auto& by) {
        const auto* other = std::get_if<std::decay_t<decltype(by)>>(&than);
        return other && by.method == other->method && by.iterations <= other->iterations &&
               by.substeps <= other->substeps;
      },
      one);
}

std::vector<AnyMethod> methods_of_springs() {
  std::vector<AnyMethod> methods;
  for (const std::string& name : method_names())
    if (const AnyMethod method = *method_called(name); std::holds_alternative<cases::StepMethod>(method))
      methods.push_back(method);
  return methods;
}

class Search {
 public:
  /// @param reference_step  a motion's, s
  Search(Sweep& sweep, Extent extent, double reference_step, const std::function<void(const Sweep&)>& on_row)
      : sweep_(sweep), extent_(extent), reference_step_(reference_step), on_row_(on_row),
        definition_(sweep.definition), given_(definition_.msm.real_time.value_or(cases::RealTime{})) {
    if (definition_.dynamics) given_.step = definition_.dynamics->step;
  }

  void run() {
    sweep_.plan.levels = {Cells{}};
    if (has_levels(definition_))
      sweep_.plan.levels = definition_.dynamics ? levels_in_time(definition_, extent_, sweep_.plan.left_out)
                                                : levels_of(definition_, extent_);
    else
      leave_out("other cells", "only a whole box is divided anew: these are the cells of the body's mesh");
    if (!find_reference()) return;
    const Stopwatch search;
    seconds_ = [search] { return search.seconds(); };
    for (const Cells& cells : sweep_.plan.levels)
      if (!add_level(cells)) break;
    follow();
    time_front();
  }

 private:
  Sweep& sweep_;
  Extent extent_;
  double reference_step_;
  const std::function<void(const Sweep&)>& on_row_;
  cases::Case definition_;
  cases::RealTime given_;
  cases::Scene own_;        ///< the scene of the body's own mesh
  cases::Trajectory truth_; ///< a motion's
  std::function<double()> seconds_;
  std::vector<SteppedBody> bodies_;
  std::vector<Candidate> candidates_;

  double budget() const { return sweep_.rate->budget_seconds; }
  double most_seconds() const { return most_frames / sweep_.rate->hertz; }
  void leave_out(const std::string& what, const std::string& why) {
    sweep_.plan.left_out.push_back({what, why});
  }
  Variant variant_of(const Candidate& one) const {
    Variant variant = bodies_[one.body].variant;
    variant.real_time = one.steps;
    return variant;
  }

  bool find_reference() {
    own_ = make_scene_within_memory(definition_);
    if (!definition_.dynamics) {
      const Answers fem = solve_reference(own_);
      if (!fem.fem.converged()) {
        sweep_.reason_without_reference = "the finite elements were not solved: " + fem.fem.solution.message;
        return false;
      }
      sweep_.reference = reference_of(compare_sides(own_, fem, Answers{}));
      return true;
    }
    if (sweep_.plan.levels.front() != Cells{}) {
      truth_ = add_reference_motion(sweep_, sweep_.plan.levels, reference_step_);
      return true;
    }
    cases::Scene reference = own_;
    reference.definition.dynamics->step = reference_step_;
    const Answer whole = solve_fem_as_given(reference),
                 half = solve_fem_as_given(with_half_the_step(reference));
    for (const Answer* answer : {&whole, &half})
      if (!answer->converged() || !answer->solution.trajectory)
        throw cases::SolveError("the reference of the sweep: " + answer->solution.message);
    truth_ = *half.solution.trajectory;
    const auto change = motion_error_percent(truth_, *whole.solution.trajectory);
    if (!change)
      throw cases::InputError(definition_.file +
                              ": measure: no node of a measure moves, so that no motion has an error");
    ReferenceValue& found = sweep_.reference.emplace().field;
    found.note = fmt::format(
        "the finite elements on the same mesh, whose own error is not known, with steps of {:g} ms",
        500 * reference_step_);
    found.uncertainty_percent = *change;
    return true;
  }

  cases::Scene scene_on_level(const Cells& cells) const {
    if (cells == Cells{}) return own_;
    cases::Case definition = definition_;
    if (!definition.dynamics) definition.measures.clear(); // their nodes need not exist on every mesh
    return scene_on(definition, cells);
  }

  /// The scene without its steps.
  static cases::Scene in_equilibrium(cases::Scene scene) {
    scene.definition.msm.real_time.reset();
    scene.definition.dynamics.reset();
    return scene;
  }

  void add_row(const Variant& variant, cases::Solution solution) {
    SweepRow& row = sweep_.rows.emplace_back(SweepRow{variant, {}});
    row.run.first = std::move(solution);
    on_row_(sweep_);
  }

  /// The designs on a level whose springs are the best ones in equilibrium, and the case's own.
  std::vector<SteppedBody> best_bodies(const Cells& cells) {
    std::vector<SweptSprings> all =
        springs_to_sweep(definition_.material, {cells}, Extent::quick, sweep_.plan.left_out);
    const cases::Design own = definition_.msm.design;
    if (cases::facts_of(own).source != cases::DesignSource::material) all.push_back({own, cells, {}});
    const cases::Scene scene = scene_on_level(cells);
    std::vector<SteppedBody> bodies;
    for (const SweptSprings& springs : all) {
      SteppedBody body{
          {Program::springs, springs.design, {}, {}, cells, 0}, with_design(scene, springs.design), {}};
      cases::Solution failed;
      try {
        body.springs = design_for(body.scene).springs;
        if (definition_.dynamics || find_equilibrium(body, failed)) {
          bodies.push_back(std::move(body));
          continue;
        }
      } catch (const cases::InputError& error) {
        failed = failed_solution(error);
      }
      add_row(body.variant, failed);
    }
    if (definition_.dynamics) return bodies;
    std::stable_sort(bodies.begin(), bodies.end(), [](const SteppedBody& a, const SteppedBody& b) {
      return *a.in_equilibrium_percent < *b.in_equilibrium_percent;
    });
    std::vector<SteppedBody> best;
    const auto n_kept = static_cast<std::size_t>(std::ceil(kept_designs * double(bodies.size())));
    for (SteppedBody& body : bodies)
      if (best.size() < n_kept || body.variant.design == own)
        best.push_back(std::move(body));
      else
        leave_out(full_name(body.variant),
                  fmt::format("its springs err by {:.2g} % in equilibrium, others by less",
                              *body.in_equilibrium_percent));
    return best;
  }

  /// @return false, with the reason, where there is no stable one
  bool find_equilibrium(SteppedBody& body, cases::Solution& failed) const {
    const Answer answer = solve_side([&] { return msm::Model(body.scene, body.springs); },
                                     [&](msm::Model& model) { return model.solve(limited(definition_)); });
    failed = answer.solution;
    if (!answer.converged()) return false;
    if (is_stable(answer.solution))
      body.in_equilibrium_percent =
          field_error_percent(*sweep_.reference, body.variant.cells, answer.solution.displacement);
    failed.status = cases::Status::failed;
    failed.message = is_stable(answer.solution) ? "its displacement has no error"
                                                : "its equilibrium is unstable, or has inverted cells";
    return body.in_equilibrium_percent.has_value();
  }

  /// Adds the candidates of a level whose first frames take no longer than they may.
  /// @return false when finer levels need not be tried
  bool add_level(const Cells& cells) {
    const std::string name = cells == Cells{} ? "the body" : cells_name(cells) + " cells";
    const Estimate estimate = estimate_springs(size_of(in_equilibrium(scene_on_level(cells))));
    const double left = part_for_designs * budget() - seconds_();
    const double seconds = estimate.seconds * double(msm::methods(definition_.material).size());
    if (cells != sweep_.plan.levels.front() && !(seconds <= left)) {
      leave_out(name + " and finer ones",
                fmt::format("their springs in equilibrium would take {:.2g} s of the budget", seconds));
      return false;
    }
    const std::size_t n_before = candidates_.size();
    for (SteppedBody& body : best_bodies(cells)) {
      bodies_.push_back(std::move(body));
      add_candidates(methods_of_springs());
    }
    add_elements(cells);
    if (candidates_.size() > n_before) return true;
    if (cells != sweep_.plan.levels.back())
      leave_out("finer cells", "no frame of " + name + " takes less than it may");
    return false;
  }

  /// Adds the elements on a level, on which each method steps those that it takes.
  void add_elements(const Cells& cells) {
    const cases::Scene scene = scene_on_level(cells);
    for (const std::string& name : method_names()) {
      const AnyMethod method = *method_called(name);
      if (std::holds_alternative<cases::StepMethod>(method)) continue;
      SteppedBody body{{Program::finite_elements, {}, {}, {}, cells, 0}, scene};
      try {
        set_steps(body.scene, std::get<cases::ElementRealTime>(steps_in(method, {})));
        body.variant.element = body.scene.definition.fem.element;
        bodies_.push_back(std::move(body));
        add_candidates({method});
      } catch (const cases::InputError& error) {
        leave_out(name, error.what());
      }
    }
  }

  /// Adds the last body's candidates by these methods.
  void add_candidates(const std::vector<AnyMethod>& methods) {
    std::vector<Steps> too_slow;
    std::set<AnyMethod> refused;
    std::vector<Steps> all;
    for (const AnyMethod& method : methods)
      for (const Steps& steps : steps_to_try(method, given_)) all.push_back(steps);
    for (const Steps& steps : all) {
      Candidate one{bodies_.size() - 1, steps, 0};
      const Variant variant = variant_of(one);
      const bool is_slower = std::any_of(too_slow.begin(), too_slow.end(),
                                         [&](const Steps& other) { return is_less_work(other, steps); });
      if (refused.count(method_of(steps)) > 0) continue;
      if (is_slower || !(seconds_() < part_for_designs * budget() || candidates_.empty())) {
        leave_out(full_name(variant), is_slower ? "with less work a frame is too slow already"
                                                : "the budget of first frames was spent");
        continue;
      }
      try {
        one.seconds_a_frame = *median(time_frames(bodies_.back(), steps, n_first_frames));
        if (one.seconds_a_frame <= most_seconds()) {
          candidates_.push_back(one);
          continue;
        }
        too_slow.push_back(steps);
        leave_out(full_name(variant), fmt::format("a frame takes {}, may take {}",
                                                  time_text(one.seconds_a_frame), time_text(most_seconds())));
      } catch (const cases::InputError& error) {
        refused.insert(method_of(steps)); // which cannot take the body, whatever its iterations
        add_row(variant, failed_solution(error));
      } catch (const cases::SolveError& error) {
        add_row(variant, failed_solution(error));
      }
    }
  }

  /// Rounds each of twice the time of the one before, of at least ten frames, at rest a second.
  int n_rounds() const {
    const double whole = definition_.dynamics ? definition_.dynamics->end : given_.end;
    const double least = definition_.dynamics ? 10 * given_.step : 1;
    return std::clamp(static_cast<int>(std::log2(whole / least)) + 1, 1, 5);
  }

  double time_of(int round) const {
    const double part = std::pow(0.5, n_rounds() - 1 - round);
    if (!definition_.dynamics) return std::ceil(2 * part * given_.end) / 2; // half seconds
    return std::ceil(part * definition_.dynamics->n_steps()) * given_.step;
  }

  /// The error of a candidate after a time. What still moves is no nearer to its rest than it moves.
  void find_error(Candidate& one, double time, mechanics::StillMoving still_moving) const {
    const SteppedBody& body = bodies_[one.body];
    cases::Solution& solution = one.run.first;
    one.error.reset();
    double moves_percent = 0;
    if (definition_.dynamics) {
      solution = moved_until(body, one.steps, time);
      if (solution.trajectory) one.error = motion_error_percent(truth_, *solution.trajectory);
    } else {
      Rest rest = rest_within(body, one.steps, time, still_moving);
      solution = std::move(rest.solution);
      moves_percent = rest.moves_percent;
      if (!solution.displacement.empty())
        one.error = field_error_percent(*sweep_.reference, body.variant.cells, solution.displacement);
    }
    if (solution.status == cases::Status::failed) return;
    if (one.error) *one.error += moves_percent;
    if (one.error && std::isfinite(*one.error)) return;
    solution.status = cases::Status::failed;
    solution.message = "its displacement has no finite error";
  }

  /// Runs a candidate for a round's time; what has come to rest is at rest.
  std::optional<Point> follow_for(Candidate& one, int round) {
    const bool is_last = round + 1 == n_rounds();
    cases::Solution& solution = one.run.first;
    if (definition_.dynamics || solution.status != cases::Status::converged)
      find_error(one, is_last && !definition_.dynamics ? given_.end : time_of(round),
                 is_last ? mechanics::StillMoving::fails : mechanics::StillMoving::has_mean);
    if (solution.status != cases::Status::failed)
      return Point{full_name(variant_of(one)), family_of(variant_of(one)), one.seconds_a_frame, *one.error};
    solution.displacement.clear();
    add_row(variant_of(one), solution);
    return std::nullopt;
  }

  void follow() {
    const double begin = seconds_(), part = std::max(0., budget() - begin) / n_rounds();
    const auto followed = halve(candidates_.size(),
                                {n_rounds(), 1 / sweep_.rate->hertz,
                                 [&](std::size_t c, int round) { return follow_for(candidates_[c], round); },
                                 [&](int round) { return seconds_() < begin + (round + 1) * part; },
                                 [&](std::size_t c, const std::string& why) {
                                   leave_out(full_name(variant_of(candidates_[c])), why);
                                 }});
    for (const auto& [c, point] : followed) {
      Candidate& one = candidates_[c];
      const SteppedBody& body = bodies_[one.body];
      SweepRow row{variant_of(one), std::move(one.run), one.error, {}, body.in_equilibrium_percent};
      try {
        row.run.first_seconds = {*median(time_frames(body, one.steps, n_timed_frames))};
      } catch (const cases::SolveError& error) { // further than it was followed
        leave_out(full_name(row.variant), error.what());
        continue;
      }
      if (!definition_.dynamics)
        row.measure_error_percent =
            measure_errors_percent(*sweep_.reference, body.variant.cells, row.run.first.displacement);
      row.run.first.displacement.clear();
      row.run.first.cell_volume.clear();
      row.run.first.trajectory.reset();
      sweep_.rows.push_back(std::move(row));
      on_row_(sweep_);
    }
  }

  /// Times what no other row beats again, for a time on a shared machine is noisy.
  void time_front() {
    for (const Point& point : pareto_front(points_of(sweep_, Error::field, Clock::first_answer)))
      for (SweepRow& row : sweep_.rows) {
        if (row.run.first_seconds.empty() || full_name(row.variant) != point.name) continue;
        const auto body = std::find_if(bodies_.begin(), bodies_.end(), [&](const SteppedBody& one) {
          return model_name(one.variant) == model_name(row.variant) && one.variant.cells == row.variant.cells;
        });
        while (row.run.first_seconds.size() < n_timings)
          row.run.first_seconds.push_back(
              *median(time_frames(*body, *row.variant.real_time, n_timed_frames)));
      }
    on_row_(sweep_);
  }
};

} // namespace

Sweep sweep_at_rate(cases::Case definition, const Rate& rate, Extent extent,
                    const std::function<void(const Sweep&)>& on_row) {
  const Stopwatch stopwatch;
  Sweep sweep;
  sweep.definition = std::move(definition);
  sweep.rate = rate;
  sweep.processes = Processes::this_one;
  const double reference_step = set_frames(sweep);
  Search(sweep, extent, reference_step, on_row).run();
  sweep.seconds = stopwatch.seconds();
  return sweep;
}

} // namespace springproof::compare
