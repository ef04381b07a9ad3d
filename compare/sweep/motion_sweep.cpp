#include "compare/sweep/motion_sweep.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "cases/scene/in_time.hpp"
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
constexpr double most_nodes = 70000;

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

std::vector<Cells> levels_in_time(const cases::Case& definition, Extent extent) {
  Cells cells = std::get<cases::Box>(definition.body).cells;
  if (std::all_of(cells.begin(), cells.end(), [](int n) { return n % 2 == 0; }))
    for (int& n : cells) n /= 2;
  std::vector<Cells> levels;
  for (int level = 0; level < (extent == Extent::quick ? 3 : 4); ++level) {
    double n_nodes = 1;
    for (const int n : cells) n_nodes *= n + 1;
    if (n_nodes > most_nodes) break;
    levels.push_back(cells);
    for (int& n : cells) n *= 2;
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

MotionRow timed(const std::string& method, Family family, const cases::Case& definition, const Answer& answer,
                const cases::Trajectory& reference) {
  MotionRow row{method,
                family,
                std::get<cases::Box>(definition.body).cells,
                definition.dynamics->step,
                answer.solution.status,
                answer.solution.message,
                answer.solution.unknowns};
  if (!answer.converged() || !answer.solution.trajectory) return row;
  row.seconds_per_second = answer.solve_seconds / definition.dynamics->end;
  row.error_percent = motion_error_percent(reference, *answer.solution.trajectory);
  return row;
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
  const FemAnswer found = solve_fem_as_given(cases::make_scene(exact));
  if (!found.answer.converged() || !found.answer.solution.trajectory)
    throw cases::SolveError("the reference of the sweep: " + found.answer.solution.message);
  return *found.answer.solution.trajectory;
}

std::string of_row(const MotionRow& row) {
  return fmt::format("{}, {} cells, steps of {:g} ms", row.method, cells_name(row.cells), 1e3 * row.step);
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

MotionSweep sweep_motion(const cases::Case& definition, Extent extent,
                         const std::function<void(const MotionSweep&)>& on_row) {
  if (!std::holds_alternative<cases::Box>(definition.body))
    throw cases::InputError(definition.file +
                            ": body.shape: a sweep refines the body, which must be \"box\"");
  const std::vector<Cells> levels = levels_in_time(definition, extent);
  if (levels.size() < 2)
    throw cases::InputError(definition.file +
                            ": body.cells: a sweep in time needs two meshes of at most 70,000 nodes");
  if (definition.dynamics->n_steps() % 2 != 0)
    throw cases::InputError(definition.dynamics->where,
                            "a sweep in time takes twice the step too: end must be an even number of steps");
  check_watched(definition, levels);
  const double step = definition.dynamics->step;
  const cases::Trajectory truth = reference_motion(definition, levels.back(), step / 4);
  const auto change = [&](const cases::Trajectory& coarser) {
    return motion_error_percent(truth, coarser).value_or(std::numeric_limits<double>::infinity());
  };
  MotionSweep sweep{definition,
                    fmt::format("log_strain q1_bbar, {} cells, generalized_alpha with steps of {:g} ms",
                                cells_name(levels.back()), 250 * step),
                    change(reference_motion(definition, levels[levels.size() - 2], step / 4)) +
                        change(reference_motion(definition, levels.back(), step / 2)),
                    {}};
  const std::string springs = "springs " + cases::name_of(definition.msm.design);
  const std::string elements =
      cases::name_of(definition.fem.formulation) + " " + cases::name_of(definition.fem.element);
  for (const Cells& cells : levels)
    for (const double factor : step_factors) {
      const cases::Case variant = with_steps(definition, cells, factor * step);
      const cases::Scene scene = cases::make_scene(variant);
      std::optional<msm::DesignResult> design;
      sweep.rows.push_back(timed(springs, Family::springs, variant, solve_springs(scene, 1, design), truth));
      on_row(sweep);
      sweep.rows.push_back(
          timed(elements, Family::finite_elements, variant, solve_fem_as_given(scene).answer, truth));
      on_row(sweep);
    }
  return sweep;
}

std::string interactive_sentence(const MotionSweep& sweep, double hertz) {
  const MotionRow* best = nullptr;
  for (const MotionRow& row : sweep.rows) {
    const bool keeps_up =
        row.error_percent >= 0. && row.step <= (1 + 1e-9) / hertz && row.seconds_per_second <= 1;
    if (keeps_up && (!best || *row.error_percent < *best->error_percent)) best = &row;
  }
  if (!best) return fmt::format("at {:g} Hz: none of these motions keeps up", hertz);
  const std::string error =
      *best->error_percent > sweep.uncertainty_percent
          ? fmt::format("{:.2g} %", *best->error_percent)
          : fmt::format("below the reference's uncertainty of {:.2g} %", sweep.uncertainty_percent);
  return fmt::format(
      "at {:g} Hz: {} are the most accurate that keep up: error {}, {:.2g} s of computing a second", hertz,
      of_row(*best), error, best->seconds_per_second);
}

} // namespace springproof::compare
