#include "compare/error_bars/auto_fem.hpp"

#include "cases/case/names.hpp"
#include "compare/error_bars/mesh_study.hpp"
#include "compare/measure/measure.hpp"
#include "mechanics/hexahedron.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace springproof::compare {

namespace {

constexpr double largest_unknowns = 1.5e6; ///< of a mesh that is refined to by itself: minutes and gigabytes

/// The expectations that ask something of the finite elements, with the measure of each.
std::vector<std::pair<cases::Expectation, cases::Measure>> gates_of(const cases::Case& definition) {
  std::vector<std::pair<cases::Expectation, cases::Measure>> gates;
  for (const cases::Expectation& expectation : definition.expectations)
    if (const auto* measure = find_named(definition.measures, expectation.measure);
        measure && expectation.quantity != cases::Quantity::msm)
      gates.emplace_back(expectation, *measure);
  return gates;
}

/// What the narrowest expectation tolerates, percent.
double tolerated_by_all(const cases::Scene& scene, const cases::Solution& solution) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [expectation, measure] : gates_of(scene.definition))
    least = std::min(least, tolerated_error_percent(expectation, evaluate(measure, scene, solution)));
  return least;
}

/// The linear solve, with small strain chosen, when it is good enough; else no answer yet, and why.
FemAnswer try_small_strain(const cases::Scene& scene) {
  cases::Fem linear = scene.definition.fem;
  linear.formulation = cases::Formulation::small_strain;
  FemAnswer tried = solve_fem_as_given(with_fem(scene, linear));
  const std::string finite = cases::name_of(scene.definition.fem.formulation);
  if (!tried.answer.converged())
    return {{},
            scene.definition.fem,
            {fmt::format("formulation {}: the linear solve that estimates strains failed: {}", finite,
                         tried.answer.solution.message)}};
  const double gradient = 100 * largest_gradient(scene.mesh, tried.answer.solution.displacement);
  const double tolerated = tolerated_by_all(scene, tried.answer.solution);
  const bool is_small = gradient < tolerated;
  tried.choices.push_back(fmt::format(
      "formulation {}: the largest displacement gradient of a linear solve ({:.2f} s) is {:.3g} %, {} "
      "the {:.3g} % that the narrowest expectation tolerates",
      is_small ? cases::name_of(linear.formulation) : finite, tried.answer.seconds(), gradient,
      is_small ? "below" : "not below", tolerated));
  if (is_small) return tried;
  return {{}, scene.definition.fem, tried.choices};
}

/// The expectation whose measure's error bar is furthest above what is tolerated, as a sentence; empty when
/// none is above.
std::string furthest_off(const cases::Scene& scene, const std::vector<cases::Solution>& coarse_to_fine) {
  double worst = 1;
  std::string which;
  for (const auto& [expectation, measure] : gates_of(scene.definition)) {
    std::vector<double> values;
    for (const cases::Solution& solution : coarse_to_fine)
      values.push_back(evaluate(measure, scene, solution));
    const double error =
        values.size() < 2 ? std::numeric_limits<double>::infinity() : finest_error_percent(values, 2);
    const double tolerated = tolerated_error_percent(expectation, values.back());
    if (error < tolerated * worst) continue;
    worst = error / tolerated;
    which = fmt::format("{} has an error bar of {:.3g} %, tolerated are {:.3g} %", measure.name, error,
                        tolerated);
  }
  return which;
}

/// Refines from the first answer on, to that of the last mesh.
void refine_until_accurate(const cases::Scene& scene, FemAnswer& fem) {
  std::vector<cases::Solution> solutions{fem.answer.solution};
  double total = fem.answer.seconds();
  std::string off = furthest_off(scene, solutions), gave_up;
  while (!off.empty()) {
    const double next_unknowns = 8. * double(fem.answer.solution.unknowns);
    if (next_unknowns > largest_unknowns) {
      gave_up = fmt::format("; the next mesh would have about {:.2g} unknowns", next_unknowns);
      break;
    }
    cases::Fem finer = fem.resolved;
    ++finer.refine;
    const FemAnswer next = solve_fem_as_given(with_fem(scene, finer));
    total += next.answer.seconds();
    if (!next.answer.converged()) {
      gave_up = "; the next mesh was not solved: " + next.answer.solution.message;
      break;
    }
    fem.resolved = finer;
    fem.answer = next.answer;
    solutions.push_back(next.answer.solution);
    off = furthest_off(scene, solutions);
  }
  const std::string cost = fmt::format("{} meshes, {} unknowns in the last, {:.2f} s in all",
                                       solutions.size(), fem.answer.solution.unknowns, total);
  const int refine = fem.resolved.refine;
  fem.choices.push_back(
      off.empty()
          ? fmt::format(
                "accuracy refine = {}: every error bar is below a quarter of its expectation's width ({})",
                refine, cost)
          : fmt::format("accuracy NOT REACHED at refine = {}: {} ({}){}", refine, off, cost, gave_up));
}

} // namespace

double largest_gradient(const cases::HexMesh& mesh, const std::vector<Eigen::Vector3d>& displacement) {
  double largest = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const Eigen::Vector3d centre = Eigen::Vector3d::Constant(0.5);
    const Eigen::Matrix3d gradient =
        mechanics::jacobian(cases::cell_vertices(mesh, c, displacement), centre) *
            mechanics::jacobian(cases::cell_vertices(mesh, c), centre).inverse() -
        Eigen::Matrix3d::Identity();
    largest = std::max(largest, Eigen::JacobiSVD<Eigen::Matrix3d>(gradient).singularValues()[0]);
  }
  return largest;
}

double tolerated_error_percent(const cases::Expectation& expectation, double fem) {
  const double width = expectation.interval[1] - expectation.interval[0];
  return expectation.quantity == cases::Quantity::fem ? 100 * width / std::abs(fem) / 4 : width / 4;
}

FemAnswer solve_fem(const cases::Scene& scene) {
  const cases::Fem& asked = scene.definition.fem;
  FemAnswer fem{{}, asked, {}};
  if (asked.has_auto_formulation) fem = try_small_strain(scene);
  if (!fem.answer.converged()) fem.answer = solve_fem_as_given(scene).answer;
  if (!asked.has_auto_accuracy || !fem.answer.converged()) return fem;
  if (const auto reason = reason_without_continuum_limit(scene))
    fem.choices.push_back("accuracy refine = 0: " + *reason);
  else
    refine_until_accurate(scene, fem);
  return fem;
}

} // namespace springproof::compare
