#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/app/commands.hpp"
#include "compare/cube/write_design.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/measure/measure.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/table/json.hpp"
#include "compare/write/write.hpp"
#include "mechanics/interruption.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <mutex>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <thread>

// The extension module of python/springproof: cases, solutions and designs, as arrays and as --json has them.
namespace py = pybind11;
using namespace springproof;

namespace {

/// One model's answer to a case, measured as `run --only` measures it.
struct Solution {
  std::shared_ptr<cases::Scene> scene; ///< that was solved, kept alive
  cases::Side side;
  compare::Comparison comparison;

  const compare::Answer& answer() const {
    return side == cases::Side::fem ? comparison.answers.fem : comparison.answers.msm;
  }
  const cases::Solution& solution() const { return answer().solution; }
  std::string described() const {
    return fmt::format("of '{}' by {}", scene->definition.name, cases::name_of(side));
  }
};

/// A copy of vectors of so many numbers, a row of an array each.
template<class Number, class Vectors>
py::array_t<Number> rows(const Vectors& vectors, std::size_t width) {
  py::array_t<Number> array({vectors.size(), width});
  Number* to = array.mutable_data();
  for (const auto& vector : vectors) to = std::copy_n(vector.data(), width, to);
  return array;
}

/// The numbers of a solution where they are: an array that cannot be written to, and keeps the solution
/// alive.
/// @param shape  dimensions of the doubles, which lie one after the other
template<class Value>
py::array view(const py::object& owner, const std::vector<Value>& values, std::vector<py::ssize_t> shape) {
  static_assert(sizeof(Value) % sizeof(double) == 0);
  py::array_t<double> array(std::move(shape), reinterpret_cast<const double*>(values.data()), owner);
  if (static_cast<std::size_t>(array.size()) != values.size() * (sizeof(Value) / sizeof(double)))
    throw std::logic_error("a solution's numbers are not of its mesh");
  array.attr("flags").attr("writeable") = false;
  return std::move(array);
}
template<class Value>
py::array view(const py::object& owner, const std::vector<Value>& values) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(values.size())};
  if (sizeof(Value) > sizeof(double)) shape.push_back(sizeof(Value) / sizeof(double));
  return view(owner, values, std::move(shape));
}

const cases::Fields& fields_of(const Solution& solution) {
  if (!solution.solution().fields)
    throw cases::InputError(
        "the solution " + solution.described() +
        " is a motion, which has displacements and volumes alone: reactions, stress, strain and "
        "energy are of cases without [dynamics]");
  return *solution.solution().fields;
}

const cases::Fields& fields_of_cells(const Solution& solution) {
  const cases::Fields& fields = fields_of(solution);
  if (!fields.has_stress)
    throw cases::InputError(
        "these springs belong to no cell: there is no stress and no strain energy of cells");
  return fields;
}

const cases::Trajectory& trajectory_of(const Solution& solution) {
  if (!solution.solution().trajectory)
    throw cases::InputError("the solution " + solution.described() +
                            " is an equilibrium, which has no course over time: that is of cases with "
                            "[dynamics]");
  return *solution.solution().trajectory;
}

py::array bodies_of(const Solution& solution) {
  const cases::Trajectory& trajectory = trajectory_of(solution);
  py::array_t<double> array(
      {trajectory.bodies.size(), solution.solution().displacement.size(), std::size_t{3}});
  double* to = array.mutable_data();
  for (const auto& body : trajectory.bodies)
    for (const Eigen::Vector3d& u : body.displacement) to = std::copy(u.data(), u.data() + 3, to);
  return std::move(array);
}

/// What the program prints beside the numbers of a side: warnings of the design and of steps in time, what is
/// to be said of how it was solved, and what fails a `run`.
std::vector<std::string> warnings_of(const Solution& solution) {
  std::vector<std::string> all;
  const auto add = [&all](const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  if (const auto& design = solution.comparison.answers.design) add(design->warnings);
  add(compare::notes_on_motion(solution.comparison));
  if (!solution.solution().message.empty()) all.push_back(solution.solution().message);
  add(solution.comparison.doubts());
  return all;
}

std::map<std::string, std::optional<double>> measure(const std::shared_ptr<cases::Scene>& scene,
                                                     const Solution& solution) {
  if (solution.scene != scene)
    throw cases::InputError("the solution " + solution.described() +
                            " is not of this Case: measure it with the one that solved it, solution.case");
  std::map<std::string, std::optional<double>> values;
  for (const cases::Measure& of : scene->definition.measures) {
    const compare::MeasuredValue& value = *compare::find_named(solution.comparison.measures, of.name);
    values[of.name] = solution.side == cases::Side::fem ? value.fem : value.msm;
  }
  return values;
}

std::shared_ptr<cases::Scene> read_scene(const std::string& path, const std::vector<std::string>& settings) {
  cases::Scene scene = compare::make_scene_within_memory(cases::read_case(path, settings));
  scene.definition.has_fields = true;
  return std::make_shared<cases::Scene>(std::move(scene));
}

/// A signal's handler in Python has raised, Ctrl-C's for one, and its exception waits; or Python ends.
struct Interrupted {};

/// Python ends while threads solve, which it would leave behind: MPI and PETSc end with it.
std::atomic<bool> is_ending{false};
std::atomic<int> n_solving{0};

void check_signals() {
  if (is_ending) throw Interrupted{};
  const py::gil_scoped_acquire python;
  if (PyErr_CheckSignals() != 0) throw Interrupted{};
}

/// Checks signals every 100 ms: between iterations, which may be many a millisecond.
void check_signals_now_and_then() {
  thread_local auto last = std::chrono::steady_clock::now();
  const auto now = std::chrono::steady_clock::now();
  if (now - last < std::chrono::milliseconds(100)) return;
  last = now;
  check_signals();
}

/// What Python calls at its end, before it stops all other threads.
void end_solves() {
  is_ending = true;
  const py::gil_scoped_release others_may_run;
  while (n_solving > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

class Counted {
 public:
  Counted() { ++n_solving; }
  ~Counted() { --n_solving; }
  Counted(const Counted&) = delete;
};

/// PETSc and MPI, which finite elements and solver = "snes" use, are not made for threads. Taken and given
/// back without Python's own lock (the GIL), so that neither is waited for by the holder of the other; a
/// signal's handler, which runs in the midst of a solve, may solve too.
std::recursive_timed_mutex one_at_a_time;

compare::Answers solve(const cases::Scene& scene, const compare::Request& request) try {
  const Counted until_python_has_this_thread_again;
  const py::gil_scoped_release others_may_run;
  std::unique_lock alone(one_at_a_time, std::defer_lock);
  if (request.asks(cases::Side::fem) || scene.definition.msm.solver == cases::Solver::snes)
    while (!alone.try_lock_for(std::chrono::milliseconds(100))) check_signals();
  compare::use_one_blas_thread(); // cases side by side are what fills the cores
  compare::check_memory({{scene, request}});
  return compare::solve(scene, request, compare::solve_fem);
} catch (const Interrupted&) {
  if (!PyErr_Occurred()) PyErr_SetString(PyExc_SystemExit, "Python ends");
  throw py::error_already_set();
}

/// @throws SolveError where the program would print a failed row
std::shared_ptr<Solution> solve_side(const std::shared_ptr<cases::Scene>& scene, const std::string& side) {
  compare::Request request;
  request.only = cases::value_of<cases::Side>(side);
  if (!request.only)
    throw cases::InputError("side: is \"" + side + "\", must be " +
                            cases::alternatives(cases::all_names<cases::Side>()));
  cases::Scene as_it_is = *scene;
  as_it_is.definition.fem.has_auto_accuracy = false; // one mesh
  compare::Answers answers = solve(as_it_is, request);
  auto solution = std::make_shared<Solution>(
      Solution{scene, *request.only, compare::comparison_of(std::move(as_it_is), std::move(answers))});
  if (!solution->answer().converged())
    throw cases::SolveError(solution->solution().message, solution->solution());
  return solution;
}

std::string compare_text(const cases::Scene& scene) {
  return compare::json_text(compare::case_to_json(compare::comparison_of(scene, solve(scene, {}))));
}

/// @param words  as after `springproof design`
std::string design_text(std::vector<std::string> words) {
  compare::DesignOptions options;
  CLI::App command;
  command.set_help_flag();
  compare::add_design_options(command, options);
  std::reverse(words.begin(), words.end()); // CLI11 takes the last first
  try {
    command.parse(words);
  } catch (const CLI::ParseError& error) {
    throw cases::InputError(error.what());
  }
  return compare::json_text(compare::attempt_to_json(compare::attempt_one(compare::request_from(options))));
}

std::string shown(const cases::Scene& scene) {
  return fmt::format("<springproof.Case '{}': {} nodes, {} cells{}>", scene.definition.name,
                     scene.mesh.nodes.size(), scene.mesh.cells.size(),
                     scene.definition.dynamics ? ", in time" : "");
}

std::string shown(const Solution& solution) {
  const cases::Solution& s = solution.solution();
  const std::string what =
      s.trajectory
          ? fmt::format("{} steps to {:.6g} s", s.trajectory->time.size() - 1, s.trajectory->time.back())
          : fmt::format("{}, residual {:.1e}", cases::name_of(s.outcome), s.residual);
  return fmt::format("<springproof.Solution {}: {} unknowns, {}>", solution.described(), s.unknowns, what);
}

} // namespace

PYBIND11_MODULE(_springproof, module) {
  py::register_exception<cases::InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<cases::SolveError>(module, "SolveError", PyExc_RuntimeError);
  mechanics::set_interruption(check_signals_now_and_then);
  py::module_::import("atexit").attr("register")(py::cpp_function(end_solves));
  module.def("program_version", compare::program_version);
  module.def("read_case", read_scene);
  module.def("design", design_text);

  py::class_<Solution, std::shared_ptr<Solution>> type(
      module, "Solution",
      "One model's equilibrium, on the nodes and cells of the case's mesh; of a case with [dynamics] its "
      "motion, and the rest is of the end. Arrays cannot be written to: copy() them.");
  type.def("__repr__", [](const Solution& s) { return shown(s); });
  const auto value = [&](const char* name, const char* text, auto get) {
    type.def_property_readonly(name, get, text);
  };
  // The numbers of the solution themselves, which the array keeps alive.
  const auto array = [&](const char* name, const char* text, auto get) {
    value(name, text,
          [get](const py::object& self) { return view(self, get(self.cast<const Solution&>())); });
  };
  value("case", "the Case that was solved", [](const Solution& s) { return s.scene; });
  value("side", "\"msm\" or \"fem\"", [](const Solution& s) { return cases::name_of(s.side); });
  array(
      "displacement", "mm, a row per node",
      [](const Solution& s) -> auto& { return s.solution().displacement; });
  array(
      "reaction", "force of the supports on the body, N, a row per node",
      [](const Solution& s) -> auto& { return fields_of(s).reaction; });
  array(
      "cell_volume", "deformed, mm3", [](const Solution& s) -> auto& { return s.solution().cell_volume; });
  array(
      "stress", "mean Cauchy stress of each cell, MPa: xx, yy, zz, xy, yz, xz",
      [](const Solution& s) -> auto& { return fields_of_cells(s).stress; });
  array(
      "strain",
      "logarithmic strain of each cell, the linear one of small_strain elements: xx, yy, zz, xy, yz, xz",
      [](const Solution& s) -> auto& { return fields_of(s).strain; });
  value("strain_energy", "of the whole body, N mm",
        [](const Solution& s) { return fields_of(s).total_energy; });
  array(
      "times", "of a motion: the start and the end of every step, s",
      [](const Solution& s) -> auto& { return trajectory_of(s).time; });
  value("watched_nodes", "of a motion: the nodes that its measures read, in the order of `trajectory`",
        [](const Solution& s) { return py::array_t<int>(py::cast(trajectory_of(s).nodes)); });
  value("trajectory", "of a motion: displacements of the watched nodes, mm, (times, watched nodes, 3)",
        [](const py::object& self) {
          const cases::Trajectory& t = trajectory_of(self.cast<const Solution&>());
          const auto n_times = static_cast<py::ssize_t>(t.time.size());
          return view(self, t.displacement, {n_times, static_cast<py::ssize_t>(t.nodes.size()), 3});
        });
  array(
      "volumes", "of a motion: the body's volume at every time, mm3; empty unless a measure is of it",
      [](const Solution& s) -> auto& { return trajectory_of(s).volume; });
  value("body_times", "of a motion: times of `bodies`, s: every dynamics.write_every steps",
        [](const Solution& s) {
          std::vector<double> times;
          for (const auto& body : trajectory_of(s).bodies)
            times.push_back(trajectory_of(s).time[cases::index(body.step)]);
          return py::array_t<double>(py::cast(times));
        });
  value("bodies", "of a motion: displacements of all nodes now and then, mm, (body_times, nodes, 3)",
        bodies_of);
  value("outcome", "\"stable equilibrium\", \"unstable equilibrium\" or \"unknown\"",
        [](const Solution& s) { return cases::name_of(s.solution().outcome); });
  value("inverted_cells", "how many", [](const Solution& s) { return s.solution().inverted_cells; });
  value("warnings", "what the program prints of it; solve() has warned of them", warnings_of);
  value("choices", "what \"auto\" in [fem] was taken to mean, with the reasons",
        [](const Solution& s) { return s.comparison.answers.choices; });
  value("unknowns", nullptr, [](const Solution& s) { return s.solution().unknowns; });
  value("residual", nullptr, [](const Solution& s) { return s.solution().residual; });
  value("newton_iterations", nullptr, [](const Solution& s) { return s.solution().newton_iterations; });
  value("seconds", nullptr, [](const Solution& s) { return s.answer().seconds(); });

  py::class_<cases::Scene, std::shared_ptr<cases::Scene>>(
      module, "Case", "A case file, with its mesh built and its regions found.")
      .def("__repr__", [](const cases::Scene& s) { return shown(s); })
      .def_property_readonly("name", [](const cases::Scene& s) { return s.definition.name; })
      .def_property_readonly("description", [](const cases::Scene& s) { return s.definition.description; })
      .def_property_readonly(
          "nodes", [](const cases::Scene& s) { return rows<double>(s.mesh.nodes, 3); }, "mm, a row per node")
      .def_property_readonly(
          "cells",
          [](const cases::Scene& s) {
            return rows<int>(s.mesh.cells, cases::reference_cell(s.mesh.shape).n_vertices);
          },
          "nodes of each hexahedron, 8: that at (i, j, k) of its corners is number i + 2 j + 4 k; or of each "
          "tetrahedron, 4")
      .def_property_readonly(
          "units",
          [](const cases::Scene& s) {
            std::map<std::string, std::string> units;
            for (const cases::Measure& m : s.definition.measures) units[m.name] = compare::unit_of(m);
            return units;
          },
          "of each measure")
      .def("_solve", solve_side)
      .def("measure", measure, py::arg("solution"),
           "The value of each measure on a solution of this case; None where it has none, such as the "
           "frequency of what does not swing.")
      .def("_compare", compare_text);
}
