#include "compare/sweep/motion_sweep.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "cases/scene/in_time.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"
#include "compare/write/csv.hpp"
#include "compare/write/gnuplot.hpp"
#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace springproof::compare {

namespace {

using Cells = std::array<int, 3>;

constexpr std::array<double, 3> step_factors{2, 1, 0.5};
constexpr std::array<double, 3> marks_of_steps{5, 7, 9}; ///< square, disc, triangle, of gnuplot
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

void write_motion_sweep_text(std::ostream& out, const MotionSweep& sweep) {
  print(out, "{}: {}\n", sweep.definition.name, sweep.definition.description);
  print(out, "  one run of each on one thread, one after the other; times without setting up\n");
  print(out, "  reference: {}; uncertainty {:.2g} %\n", sweep.reference, sweep.uncertainty_percent);
  print(out, "  {:<34}{:>12} {:>9} {:>9} {:>24} {:>9}\n", "method", "cells", "step, ms", "unknowns",
        "s of computing a second", "error, %");
  for (const MotionRow& row : sweep.rows) {
    print(out, "  {:<34}{:>12} {:>9.4g} {:>9}", row.method, cells_name(row.cells), 1e3 * row.step,
          row.unknowns);
    if (row.error_percent)
      print(out, " {:>24.3g} {:>9.3g}\n", row.seconds_per_second, *row.error_percent);
    else
      print(out, " {}: {}\n", cases::name_of(row.status), row.message);
  }
  for (const double hertz : {30., 60., 500.}) print(out, "{}\n", interactive_sentence(sweep, hertz));
}

void write_motion_sweep_csv(std::ostream& out, const MotionSweep& sweep) {
  CsvWriter csv(out, 10);
  csv.row("case", "method", "cells_x", "cells_y", "cells_z", "step_s", "status", "message", "unknowns",
          "seconds_per_second", "error_percent");
  for (const MotionRow& row : sweep.rows) {
    const auto seconds = row.error_percent ? std::optional(row.seconds_per_second) : std::nullopt;
    csv.row(sweep.definition.name, row.method, row.cells[0], row.cells[1], row.cells[2], row.step,
            cases::name_of(row.status), row.message, row.unknowns, seconds, row.error_percent);
  }
}

nlohmann::ordered_json motion_sweep_to_json(const MotionSweep& sweep) {
  using Json = nlohmann::ordered_json;
  Json document = provenance();
  document["case"] = sweep.definition.name;
  document["description"] = sweep.definition.description;
  document["threads"] = 1;
  document["reference"] = {{"motion", sweep.reference}, {"uncertainty_percent", sweep.uncertainty_percent}};
  document["motions"] = Json::array();
  for (const MotionRow& row : sweep.rows) {
    Json entry{{"method", row.method},          {"cells", row.cells},
               {"step_seconds", row.step},      {"status", cases::name_of(row.status)},
               {"message", row.message},        {"unknowns", row.unknowns},
               {"seconds_per_second", nullptr}, {"error_percent", nullptr}};
    if (row.error_percent) {
      entry["seconds_per_second"] = row.seconds_per_second;
      entry["error_percent"] = *row.error_percent;
    }
    document["motions"].push_back(entry);
  }
  document["conclusions"] = Json::array();
  for (const double hertz : {30., 60., 500.})
    document["conclusions"].push_back(interactive_sentence(sweep, hertz));
  return document;
}

void plot_motion_sweep(const std::string& folder, const MotionSweep& sweep) {
  std::vector<std::string> lines; // a block for each method and step
  std::vector<double> linetypes;  // as in all figures; a step's mark is the same for both models
  std::vector<double> markers;
  write_file(folder + "/motion_sweep_points.csv", [&](std::ostream& out) {
    CsvWriter csv(out, 8);
    for (const Family family : {Family::springs, Family::finite_elements})
      for (std::size_t s = 0; s < step_factors.size(); ++s) {
        const double step = step_factors[s] * sweep.definition.dynamics->step;
        std::string name;
        for (const MotionRow& row : sweep.rows) {
          if (row.family != family || std::abs(row.step - step) > 1e-9 * step || !row.error_percent) continue;
          name = fmt::format("{}, {:g} ms", row.method, 1e3 * step);
          csv.row(row.seconds_per_second, *row.error_percent);
        }
        if (name.empty()) continue;
        csv.end_block();
        lines.push_back(name);
        linetypes.push_back(family == Family::finite_elements ? 1 : 2);
        markers.push_back(marks_of_steps[s]);
      }
  });
  if (lines.empty()) return;
  draw(folder, "motion_sweep", "motion_sweep",
       {{"points", "motion_sweep_points.csv"},
        {"headline", sweep.definition.name + ": motions, one thread"},
        {"lines", lines},
        {"linetypes", linetypes},
        {"markers", markers},
        {"uncertainty", sweep.uncertainty_percent},
        {"width", 1000.},
        {"height", 600.}});
}

} // namespace springproof::compare
