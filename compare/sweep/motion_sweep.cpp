#include "compare/sweep/sweep.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "cases/scene/scene.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace springproof::compare {

namespace {

using Cells = std::array<int, 3>;

/// Finite elements take no larger bodies through all steps: half an hour a motion.
constexpr long most_nodes = 70000;

/// The case on another mesh with another step; whole bodies at the ends alone.
cases::Case with_steps(const cases::Case& definition, const Cells& cells, double step) {
  cases::Case result = definition;
  std::get<cases::Box>(result.body).cells = cells;
  result.fem.refine = 0;
  result.dynamics->step = step;
  result.dynamics->write_every = std::numeric_limits<int>::max();
  result.expectations.clear();
  return result;
}

/// Levels that are too large are left out.
std::vector<Cells> small_levels(const cases::Case& definition, Extent extent,
                                std::vector<LeftOut>& left_out) {
  std::vector<Cells> levels;
  for (const Cells& cells : levels_of(definition, extent)) {
    long n_nodes = 1;
    for (const int n : cells) n_nodes *= n + 1;
    if (n_nodes <= most_nodes)
      levels.push_back(cells);
    else
      left_out.push_back({"all motions of " + cells_name(cells) + " cells",
                          fmt::format("{} nodes, above the limit of {}", n_nodes, most_nodes)});
  }
  return levels;
}

std::vector<Eigen::Vector3d> places_of_watched(const cases::Scene& scene) {
  std::vector<Eigen::Vector3d> places;
  for (const int node : cases::watched_nodes(scene)) places.push_back(scene.mesh.nodes[cases::index(node)]);
  return places;
}

/// Nodes of boxes come in one order of their places on every level, so that watched ones do too.
void check_watched(const cases::Case& definition, const std::vector<Cells>& levels) {
  const double step = definition.dynamics->step;
  const auto finest = places_of_watched(cases::make_scene(with_steps(definition, levels.back(), step)));
  if (finest.empty())
    throw cases::InputError(definition.file +
                            ": measure: a sweep in time follows the nodes of measures: none is there");
  for (const Cells& cells : levels) {
    const auto places = places_of_watched(cases::make_scene(with_steps(definition, cells, step)));
    bool are_equal = places.size() == finest.size();
    for (std::size_t n = 0; are_equal && n < places.size(); ++n)
      are_equal = (places[n] - finest[n]).norm() <= 1e-9 * (1 + finest[n].norm());
    if (!are_equal)
      throw cases::InputError(definition.file + ": measure: its nodes are not on the mesh of " +
                              cells_name(cells) +
                              " cells: a sweep in time compares nodes that all meshes have");
  }
}

/// The designs that a sweep takes, and the case's own, which has all steps in a quick sweep too.
std::vector<SweptSprings> springs_in_time(const cases::Case& definition, const std::vector<Cells>& levels,
                                          Extent extent, std::vector<LeftOut>& left_out) {
  std::vector<SweptSprings> all = springs_to_sweep(definition.material, levels, extent, left_out);
  const cases::Design own = definition.msm.design;
  if (cases::facts_of(own).source != cases::DesignSource::material)
    for (const Cells& cells : levels) all.push_back({own, cells, Settings::all});
  for (SweptSprings& springs : all)
    if (springs.design == own) springs.settings = Settings::all;
  if (extent == Extent::quick)
    left_out.push_back({"the finest level, and other steps than the case's of all designs but its own",
                        "--quick was asked for"});
  return all;
}

/// A case that no model can be made of is a failed answer, as one that is not solved.
Answer answered(const std::function<Answer()>& solve) {
  try {
    return solve();
  } catch (const cases::InputError& error) {
    Answer refused;
    refused.solution = failed_solution(error);
    return refused;
  }
}

/// Gives a row its error, or lets it fail with the reason why there is none.
void hold_against(const cases::Trajectory& reference, const Answer& answer, const cases::Case& definition,
                  SweepRow& row) {
  const cases::Solution& solution = answer.solution;
  cases::Solution& kept = row.run.first;
  kept.status = solution.status;
  kept.message = solution.message;
  kept.unknowns = solution.unknowns;
  if (!answer.converged()) return;
  const auto error =
      solution.trajectory ? motion_error_percent(reference, *solution.trajectory) : std::nullopt;
  if (!error || !std::isfinite(*error)) {
    kept.status = cases::Status::failed;
    kept.message = "its displacements are not finite, or not of the nodes and times of the reference";
    return;
  }
  row.run.first_seconds = {answer.solve_seconds / definition.dynamics->end};
  row.field_error_percent = error;
}

/// Finite strain by a scheme of second order, whatever the case has.
cases::Trajectory reference_motion(const cases::Case& definition, const Cells& cells, double step) {
  cases::Case exact = with_steps(definition, cells, step);
  exact.fem.formulation = cases::Formulation::log_strain;
  exact.fem.element = cases::Element::q1_bbar;
  exact.fem.mass = cases::ElementMass::consistent;
  exact.dynamics->scheme = {};
  exact.dynamics->scheme.scheme = cases::Scheme::generalized_alpha;
  exact.dynamics->scheme.rho_infinity = 0.8;
  const Answer found = solve_fem_as_given(cases::make_scene(exact));
  if (!found.converged() || !found.solution.trajectory)
    throw cases::SolveError("the reference of the sweep: " + found.solution.message);
  return *found.solution.trajectory;
}

} // namespace

std::optional<double> motion_error_percent(const cases::Trajectory& reference,
                                           const cases::Trajectory& other) {
  const std::size_t n = reference.nodes.size();
  if (n == 0 || other.nodes.size() != n) return std::nullopt;
  double squared = 0, difference_squared = 0;
  std::size_t at = 0;
  for (std::size_t t = 0; t < other.time.size(); ++t) {
    const double same = 1e-9 * (1 + other.time[t]);
    while (at < reference.time.size() && reference.time[at] < other.time[t] - same) ++at;
    if (at == reference.time.size()) break;
    if (reference.time[at] > other.time[t] + same) continue;
    for (std::size_t node = 0; node < n; ++node) {
      const Eigen::Vector3d& u = reference.displacement[at * n + node];
      squared += u.squaredNorm();
      difference_squared += (other.displacement[t * n + node] - u).squaredNorm();
    }
  }
  if (!(squared > 0)) return std::nullopt;
  return 100 * std::sqrt(difference_squared / squared);
}

std::vector<Cells> levels_in_time(const cases::Case& definition, Extent extent,
                                  std::vector<LeftOut>& left_out) {
  const std::vector<Cells> levels = small_levels(definition, extent, left_out);
  if (levels.size() < 2)
    throw cases::InputError(
        definition.file +
        fmt::format(": body.cells: a sweep in time needs two meshes of at most {} nodes", most_nodes));
  if (definition.dynamics->n_steps() % 2 != 0)
    throw cases::InputError(definition.dynamics->where,
                            "a sweep in time takes twice the step too: end must be an even number of steps");
  if (definition.fem.real_time)
    throw cases::InputError(definition.fem.where,
                            "real_time must be left out of a sweep, whose finite elements are the reference");
  check_watched(definition, levels);
  return levels;
}

cases::Trajectory add_reference_motion(Sweep& sweep, const std::vector<Cells>& levels, double step) {
  const cases::Case& definition = sweep.definition;
  const cases::Trajectory truth = reference_motion(definition, levels.back(), step / 4);
  if (!motion_error_percent(truth, truth))
    throw cases::InputError(definition.file +
                            ": measure: their nodes do not move, so that no motion has an error");
  const auto change = [&](const Cells& cells, double other_step) {
    return motion_error_percent(truth, reference_motion(definition, cells, other_step))
        .value_or(std::numeric_limits<double>::infinity());
  };
  ReferenceValue& found = sweep.reference.emplace().field;
  found.note = fmt::format("log_strain q1_bbar, {} cells, generalized_alpha with steps of {:g} ms",
                           cells_name(levels.back()), 250 * step);
  found.uncertainty_percent = change(levels[levels.size() - 2], step / 4) + change(levels.back(), step / 2);
  return truth;
}

Sweep sweep_motion(const cases::Case& definition, Extent extent,
                   const std::function<void(const Sweep&)>& on_row) {
  Sweep sweep;
  sweep.definition = definition;
  const std::vector<Cells> levels = levels_in_time(definition, extent, sweep.plan.left_out);
  const cases::Trajectory truth = add_reference_motion(sweep, levels, definition.dynamics->step);
  const auto add = [&](Variant variant, Settings settings, const auto& solve) {
    for (const double factor : step_factors) {
      if (settings == Settings::one && factor != 1) continue;
      variant.step = factor * definition.dynamics->step;
      const cases::Case moved = with_steps(definition, variant.cells, variant.step);
      SweepRow& row = sweep.rows.emplace_back(SweepRow{variant, {}});
      hold_against(truth, answered([&] { return solve(cases::make_scene(moved)); }), moved, row);
      on_row(sweep);
    }
  };
  for (const SweptSprings& springs : springs_in_time(definition, levels, extent, sweep.plan.left_out))
    add({Program::springs, springs.design, {}, {}, springs.cells}, springs.settings,
        [&](const cases::Scene& scene) {
          std::optional<msm::DesignResult> made;
          return solve_springs(with_design(scene, springs.design), 1, made);
        });
  for (const Cells& cells : levels)
    add({Program::finite_elements, {}, definition.fem.formulation, definition.fem.element, cells},
        Settings::all, solve_fem_as_given);
  return sweep;
}

} // namespace springproof::compare
