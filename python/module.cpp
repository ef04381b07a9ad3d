#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/app/design_options.hpp"
#include "compare/cube/write_design.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/measure/measure.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/springs.hpp"
#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

// The extension module of python/springproof: cases, their solutions and designs, as numpy arrays and as the
// documents of --json.
namespace py = pybind11;
using namespace springproof;

namespace {

/// A copy of vectors of so many numbers, a row of an array each.
template<class Number, std::size_t width, class Vectors>
py::array_t<Number> rows(const Vectors& vectors) {
  const auto n = static_cast<py::ssize_t>(vectors.size());
  py::array_t<Number> array({n, static_cast<py::ssize_t>(width)});
  auto values = array.template mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < n; ++i)
    for (py::ssize_t j = 0; j < static_cast<py::ssize_t>(width); ++j)
      values(i, j) = vectors[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return array;
}

py::array_t<double> numbers(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

const cases::Fields& fields_of(const compare::Answer& answer) {
  if (!answer.solution.fields || !answer.solution.fields->has_stress)
    throw cases::InputError(
        "these springs belong to no cell: there is no stress and no strain energy of cells");
  return *answer.solution.fields;
}

cases::Scene read_scene(const std::string& path, const std::vector<std::string>& settings) {
  cases::Scene scene = compare::make_scene_within_memory(cases::read_case(path, settings));
  scene.definition.has_fields = true;
  return scene;
}

compare::Answers solve(const cases::Scene& scene, const compare::Request& request) {
  const py::gil_scoped_release others_may_run;
  compare::use_one_blas_thread(); // cases side by side are what fills the cores
  compare::check_memory({{scene, request}});
  return compare::solve(scene, request, compare::solve_fem);
}

/// @throws SolveError where the program would print a failed row
compare::Answer solve_side(const cases::Scene& scene, const std::string& side) {
  compare::Request request;
  request.only = cases::value_of<cases::Side>(side);
  if (!request.only)
    throw cases::InputError("side: is \"" + side + "\", must be " +
                            cases::alternatives(cases::all_names<cases::Side>()));
  cases::Scene as_it_is = scene;
  as_it_is.definition.fem.has_auto_accuracy = false; // one mesh
  const compare::Answers answers = solve(as_it_is, request);
  const compare::Answer& answer = *request.only == cases::Side::fem ? answers.fem : answers.msm;
  if (!answer.converged()) throw cases::SolveError(answer.solution.message, answer.solution);
  return answer;
}

std::string compare_text(const cases::Scene& scene) {
  return compare::json_text(compare::case_to_json(compare::comparison_of(scene, solve(scene, {}))));
}

std::string design_text(double young, double poisson, const std::string& method, double edge) {
  compare::DesignOptions options;
  options.youngs_modulus = young;
  options.poissons_ratio = poisson;
  options.method = method;
  options.edge = edge;
  if (!method.empty() && !cases::value_of<cases::Design>(method))
    throw cases::InputError("method: is \"" + method + "\", must be " +
                            cases::alternatives(cases::all_names<cases::Design>()));
  return compare::json_text(compare::attempt_to_json(compare::attempt_one(compare::request_from(options))));
}

std::map<std::string, double> measure(const cases::Scene& scene, const compare::Answer& answer) {
  std::map<std::string, double> values;
  for (const cases::Measure& of : scene.definition.measures)
    values[of.name] = compare::evaluate(of, scene, answer.solution);
  return values;
}

} // namespace

PYBIND11_MODULE(_springproof, module) {
  py::register_exception<cases::InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<cases::SolveError>(module, "SolveError", PyExc_RuntimeError);
  module.def("program_version", compare::program_version);
  module.def("read_case", read_scene);
  module.def("design", design_text);

  py::class_<compare::Answer>(module, "Solution",
                              "One model's equilibrium, on the nodes and cells of the case's mesh.")
      .def_property_readonly(
          "displacement", [](const compare::Answer& a) { return rows<double, 3>(a.solution.displacement); },
          "mm, a row per node")
      .def_property_readonly(
          "reaction", [](const compare::Answer& a) { return rows<double, 3>(a.solution.fields->reaction); },
          "force of the supports on the body, N, a row per node")
      .def_property_readonly(
          "cell_volume", [](const compare::Answer& a) { return numbers(a.solution.cell_volume); },
          "deformed, mm3")
      .def_property_readonly(
          "stress", [](const compare::Answer& a) { return rows<double, 6>(fields_of(a).stress); },
          "mean Cauchy stress of each cell, MPa: xx, yy, zz, xy, yz, xz")
      .def_property_readonly(
          "strain", [](const compare::Answer& a) { return rows<double, 6>(a.solution.fields->strain); },
          "logarithmic strain of each cell, the linear one of small_strain elements: "
          "xx, yy, zz, xy, yz, xz")
      .def_property_readonly(
          "strain_energy", [](const compare::Answer& a) { return a.solution.fields->total_energy; },
          "of the whole body, N mm")
      .def_property_readonly("unknowns", [](const compare::Answer& a) { return a.solution.unknowns; })
      .def_property_readonly("residual", [](const compare::Answer& a) { return a.solution.residual; })
      .def_property_readonly("newton_iterations",
                             [](const compare::Answer& a) { return a.solution.newton_iterations; })
      .def_property_readonly("seconds", &compare::Answer::seconds);

  py::class_<cases::Scene>(module, "Case", "A case file, with its mesh built and its regions found.")
      .def_property_readonly("name", [](const cases::Scene& s) { return s.definition.name; })
      .def_property_readonly("description", [](const cases::Scene& s) { return s.definition.description; })
      .def_property_readonly(
          "nodes", [](const cases::Scene& s) { return rows<double, 3>(s.mesh.nodes); }, "mm, a row per node")
      .def_property_readonly(
          "cells", [](const cases::Scene& s) { return rows<int, 8>(s.mesh.cells); },
          "nodes of each hexahedron, around its bottom, then around its top")
      .def_property_readonly(
          "units",
          [](const cases::Scene& s) {
            std::map<std::string, std::string> units;
            for (const cases::Measure& of : s.definition.measures) units[of.name] = compare::unit_of(of);
            return units;
          },
          "of each measure")
      .def("solve", solve_side, py::arg("side"),
           "The equilibrium of \"msm\" or \"fem\" on the case's own mesh; SolveError if there is none.")
      .def("measure", measure, py::arg("solution"), "The value of each measure on a solution.")
      .def("_compare", compare_text);
}
