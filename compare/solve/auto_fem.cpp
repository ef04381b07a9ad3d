#include "compare/solve/auto_fem.hpp"

#include "cases/case/names.hpp"
#include "compare/measure/measure.hpp"
#include "compare/solve/solve_side.hpp"
#include "fem_reference/model.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace springproof::compare {

namespace {

constexpr double largest_unknowns = 1.5e6; ///< of a mesh that is refined to by itself: minutes and gigabytes

Side solve_as_given(const cases::Scene& scene) {
  return solve_side([&] { return fem_reference::Model(scene, MPI_COMM_WORLD); },
                    [](fem_reference::Model& model) { return model.solve(); });
}

bool has_converged(const Side& side) {
  return side.solution.status == cases::Status::converged;
}

double seconds(const Side& side) {
  return side.setup_seconds + side.solve_seconds;
}

/// Columns are the trilinear map's derivatives at the cell's centre, mm.
Eigen::Matrix3d centre_jacobian(const std::array<Eigen::Vector3d, 8>& vertices) {
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  for (int v = 0; v < 8; ++v)
    for (int d = 0; d < 3; ++d)
      jacobian.col(d) += ((v >> d) & 1 ? 0.25 : -0.25) * vertices[static_cast<std::size_t>(v)];
  return jacobian;
}

/// The expectations that ask something of the finite elements, with the measure of each.
std::vector<std::pair<cases::Expectation, cases::Measure>> gates_of(const cases::Case& definition) {
  std::vector<std::pair<cases::Expectation, cases::Measure>> gates;
  for (const cases::Expectation& expectation : definition.expectations) {
    const auto measure = std::find_if(definition.measures.begin(), definition.measures.end(),
                                      [&](const cases::Measure& m) { return m.name == expectation.measure; });
    if (expectation.quantity != cases::Quantity::msm && measure != definition.measures.end())
      gates.emplace_back(expectation, *measure);
  }
  return gates;
}

/// What the narrowest expectation tolerates, percent.
double tolerated_by_all(const cases::Scene& scene, const cases::Solution& solution) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [expectation, measure] : gates_of(scene.definition))
    least = std::min(least, tolerated_error_percent(expectation, evaluate(measure, scene, solution)));
  return least;
}

/// The linear solve, when it is good enough; the definition then has small strain.
std::optional<Side> try_small_strain(cases::Scene& scene, std::vector<std::string>& choices) {
  const cases::Formulation finite = scene.definition.fem.formulation;
  scene.definition.fem.formulation = cases::Formulation::small_strain;
  Side side = solve_as_given(scene);
  if (!has_converged(side)) {
    scene.definition.fem.formulation = finite;
    choices.push_back(fmt::format("formulation {}: the linear solve that estimates strains failed: {}",
                                  cases::name_of(finite), side.solution.message));
    return std::nullopt;
  }
  const double gradient = 100 * largest_gradient(scene.mesh, side.solution.displacement);
  const double tolerated = tolerated_by_all(scene, side.solution);
  const bool is_small = gradient < tolerated;
  if (!is_small) scene.definition.fem.formulation = finite;
  choices.push_back(fmt::format(
      "formulation {}: the largest displacement gradient of a linear solve ({:.2f} s) is {:.3g} %, {} "
      "the {:.3g} % that the narrowest expectation tolerates",
      cases::name_of(scene.definition.fem.formulation), seconds(side), gradient,
      is_small ? "below" : "not below", tolerated));
  if (is_small) return side;
  return std::nullopt;
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

/// Refines from the first side on; answers the side of the last mesh.
Side refine_until_accurate(cases::Scene& scene, Side side, std::vector<std::string>& choices) {
  std::vector<cases::Solution> solutions{side.solution};
  double total = seconds(side);
  std::string off = furthest_off(scene, solutions), gave_up;
  while (!off.empty()) {
    if (8. * double(side.solution.unknowns) > largest_unknowns) {
      gave_up = fmt::format("; the next mesh would have about {:.2g} unknowns",
                            8. * double(side.solution.unknowns));
      break;
    }
    cases::Scene finer = scene;
    ++finer.definition.fem.refine;
    const Side next = solve_as_given(finer);
    total += seconds(next);
    if (!has_converged(next)) {
      gave_up = "; the next mesh was not solved: " + next.solution.message;
      break;
    }
    scene.definition.fem.refine = finer.definition.fem.refine;
    side = next;
    solutions.push_back(next.solution);
    off = furthest_off(scene, solutions);
  }
  const std::string cost = fmt::format("{} meshes, {} unknowns in the last, {:.2f} s in all",
                                       solutions.size(), side.solution.unknowns, total);
  const int refine = scene.definition.fem.refine;
  choices.push_back(
      off.empty()
          ? fmt::format(
                "accuracy refine = {}: every error bar is below a quarter of its expectation's width ({})",
                refine, cost)
          : fmt::format("accuracy NOT REACHED at refine = {}: {} ({}){}", refine, off, cost, gave_up));
  return side;
}

} // namespace

double largest_gradient(const cases::HexMesh& mesh, const std::vector<Eigen::Vector3d>& displacement) {
  double largest = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const Eigen::Matrix3d gradient = centre_jacobian(cases::cell_vertices(mesh, c, displacement)) *
                                         centre_jacobian(cases::cell_vertices(mesh, c)).inverse() -
                                     Eigen::Matrix3d::Identity();
    largest = std::max(largest, Eigen::JacobiSVD<Eigen::Matrix3d>(gradient).singularValues()[0]);
  }
  return largest;
}

double tolerated_error_percent(const cases::Expectation& expectation, double fem) {
  const double width = expectation.interval[1] - expectation.interval[0];
  return expectation.quantity == cases::Quantity::fem ? 100 * width / std::abs(fem) / 4 : width / 4;
}

Side solve_fem(cases::Scene& scene, std::vector<std::string>& choices) {
  const cases::Fem& fem = scene.definition.fem;
  std::optional<Side> side;
  if (fem.has_auto_formulation) side = try_small_strain(scene, choices);
  if (!side) side = solve_as_given(scene);
  if (!fem.has_auto_accuracy || !has_converged(*side)) return *side;
  if (const auto reason = reason_without_continuum_limit(scene)) {
    choices.push_back("accuracy refine = 0: " + *reason);
    return *side;
  }
  return refine_until_accurate(scene, *side, choices);
}

} // namespace springproof::compare
