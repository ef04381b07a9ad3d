#include "compare/error_bars/auto_fem.hpp"

#include "cases/case/names.hpp"
#include "cases/mesh/sharing.hpp"
#include "compare/error_bars/convergence.hpp"
#include "compare/measure/measure.hpp"
#include "compare/solve/estimate.hpp"
#include "mechanics/dense.hpp"
#include "mechanics/larger.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace springproof::compare {

namespace {

/// Budget of one automatically refined mesh.
constexpr double most_unknowns = 1.5e6, most_seconds = 60;
constexpr double seconds_an_iteration =
    1e-6; ///< cost of one unknown on grids; what is hard to solve takes more iterations
constexpr double default_width = 1; ///< percent: width assumed for an error without an expectation

/// The least that the expectations which ask something of the finite elements tolerate, percent; infinity
/// without one.
/// @param value_of  returns the finite elements' value of a measure; nothing where it does not count
template<class ValueOf>
double least_tolerated(const cases::Case& definition, const ValueOf& value_of) {
  double least = std::numeric_limits<double>::infinity();
  for (const cases::Expectation& expectation : definition.expectations) {
    const auto* measure = find_named(definition.measures, expectation.measure);
    if (!measure || expectation.quantity == cases::Quantity::msm) continue;
    if (const std::optional<double> value = value_of(*measure))
      least = std::min(least, tolerated_error_percent(expectation, *value));
  }
  return least;
}

/// The linear solve, with small strain chosen, when it is good enough; else no answer yet, and why.
Answers try_small_strain(const cases::Scene& scene) {
  Answers tried;
  tried.resolved = scene.definition.fem;
  cases::Fem linear = scene.definition.fem;
  linear.formulation = cases::Formulation::small_strain;
  const std::string finite = cases::name_of(scene.definition.fem.formulation);
  if (const double degrees = cases::largest_turn(scene.definition);
      degrees > cases::largest_turn_of_small_strain) {
    tried.choices = {fmt::format("formulation {}: a region is turned by {} degrees", finite, degrees)};
    return tried;
  }
  Answer answer = solve_fem_as_given(with_fem(scene, linear));
  const cases::Solution& linearly = answer.solution;
  if (!answer.converged()) {
    tried.choices = {fmt::format("formulation {}: the linear solve that estimates strains failed: {}", finite,
                                 linearly.message)};
    return tried;
  }
  const double gradient = 100 * largest_gradient(scene.mesh, linearly.displacement, linearly.sharing.get());
  const double tolerated = least_tolerated(scene.definition, [&](const cases::Measure& measure) {
    return std::optional(evaluate(measure, scene, linearly));
  });
  const bool is_small = gradient < tolerated;
  tried.choices.push_back(fmt::format(
      "formulation {}: the largest displacement gradient of a linear solve ({:.2f} s) is {:.3g} %, {} "
      "the {:.3g} % that the narrowest expectation tolerates",
      is_small ? cases::name_of(linear.formulation) : finite, answer.seconds(), gradient,
      is_small ? "below" : "not below", tolerated));
  if (is_small) {
    tried.resolved = linear;
    tried.fem = std::move(answer);
  }
  return tried;
}

/// What the reference of a measure may be uncertain by, percent of it.
double wanted_percent(const cases::Scene& scene, const std::string& measure, double reference) {
  const double least = least_tolerated(scene.definition, [&](const cases::Measure& expected_of) {
    return expected_of.name == measure ? std::optional(reference) : std::nullopt;
  });
  return std::isfinite(least) ? least : default_width / 4;
}

/// Whether values that turn stay within what is wanted over the last three changes, or within a hundredth of
/// it.
bool is_confirmed(const StudiedMeasure& measure, double wanted_percent) {
  const auto& values = measure.values;
  const std::size_t n = values.size();
  double largest = 0;
  for (std::size_t i = n > 3 ? n - 3 : 1; i < n; ++i)
    largest = mechanics::larger(largest, std::abs(values[i] - values[i - 1]));
  const double percent = 100 * largest / std::abs(values.back());
  return percent <= (n > 3 ? wanted_percent : wanted_percent / 100);
}

/// The measure whose reference is furthest from being known well enough, as a sentence; empty when all are.
std::string furthest_off(const cases::Scene& scene, const MeshStudy& study) {
  double worst = 1;
  std::string which;
  for (const StudiedMeasure& measure : study.measures) {
    if (!measure.reference) return fmt::format("the reference of {}: {}", measure.name, measure.no_reference);
    const double value = measure.reference->value,
                 known = 100 * measure.reference->uncertainty / std::abs(value),
                 wanted = wanted_percent(scene, measure.name, value);
    if (measure.reference->turns && !is_confirmed(measure, wanted))
      return fmt::format("the reference of {}: {}, and one more mesh has to show where the values go",
                         measure.name, measure.reference->note);
    if (!(known > wanted * worst)) continue; // a reference of zero has no relative error
    worst = known / wanted;
    which = fmt::format("the reference of {} is known to {:.2g} %, {:.2g} % is wanted", measure.name, known,
                        wanted);
  }
  return which;
}

/// The finite elements on further meshes, from an answer on the case's own.
class Refinement {
 public:
  Refinement(const cases::Scene& scene, const Answers& own, const KeptMeshes& kept)
      : scene_(scene), own_(own), kept_(kept) {}

  /// Solves one more mesh, coarser than the others or finer.  @return whether there is an answer
  bool add(int refine) {
    cases::Fem fem = own_.resolved;
    fem.refine = refine;
    Answer answer;
    if (refine == own_.resolved.refine) {
      answer = own_.fem;
    } else if (auto earlier = kept_.find(fem)) {
      answer = std::move(*earlier);
    } else {
      answer = solve_fem_as_given(with_fem(scene_, fem));
      if (answer.converged()) kept_.keep(fem, answer);
    }
    seconds_ += answer.seconds();
    if (!answer.converged()) {
      meshes_.reason =
          fmt::format("the mesh refined {} times was not solved: {}", refine, answer.solution.message);
      return false;
    }
    const bool is_finer = meshes_.refine.empty() || refine > meshes_.refine.back();
    meshes_.refine.insert(is_finer ? meshes_.refine.end() : meshes_.refine.begin(), refine);
    meshes_.solutions.insert(is_finer ? meshes_.solutions.end() : meshes_.solutions.begin(), answer.solution);
    return true;
  }
  const RefinedMeshes& meshes() const { return meshes_; }
  double seconds() const { return seconds_; }

 private:
  const cases::Scene& scene_;
  const Answers& own_;
  const KeptMeshes& kept_;
  RefinedMeshes meshes_;
  double seconds_ = 0;
};

/// Exactly so many meshes, as far as they can be solved.
RefinedMeshes solve_meshes(const cases::Scene& scene, const Answers& own, int n_meshes,
                           const KeptMeshes& kept) {
  Refinement refinement(scene, own, kept);
  const int own_refine = own.resolved.refine, finest = std::max(n_meshes - 1, own_refine);
  refinement.add(own_refine);
  for (int refine = own_refine - 1; refine > finest - n_meshes && refinement.add(refine);) --refine;
  for (int refine = own_refine + 1; refine <= finest && refinement.add(refine);) ++refine;
  return refinement.meshes();
}

/// Why a finer mesh is not solved without being asked for; empty when it is.
/// @param last  answer on the mesh of twice the width
std::string why_not_finer(const cases::Scene& finer, const cases::Solution& last) {
  const Estimate next = estimate_fem(size_of(finer));
  const double by_iterations =
                   8 * static_cast<double>(last.unknowns) * static_cast<double>(last.linear_iterations),
               seconds = std::max(next.seconds, by_iterations * seconds_an_iteration);
  const MemoryLimit limit = memory_limit();
  if (next.unknowns <= most_unknowns && seconds <= most_seconds &&
      megabytes_within(limit, next) <= limit.megabytes)
    return "";
  return fmt::format(
      "the next mesh would have about {:.2g} unknowns, and take {:.0f} s and {:.0f} MB (--converge "
      "asks for it)",
      next.unknowns, seconds, next.megabytes);
}

/// Refines until the reference is known well enough, or the budget is spent.
/// @param told  gets a line on what was done
RefinedMeshes refine_until_known(const cases::Scene& scene, const Answers& own, const KeptMeshes& kept,
                                 std::vector<std::string>& told) {
  Refinement refinement(scene, own, kept);
  const int own_refine = own.resolved.refine;
  refinement.add(own_refine);
  // Coarser meshes cost next to nothing, and show whether the order is the same twice.
  for (int refine = own_refine - 1; refine >= std::max(0, own_refine - 2) && refinement.add(refine);)
    --refine;
  std::string off, gave_up;
  for (int refine = own_refine + 1;; ++refine) {
    off = furthest_off(scene, study_meshes(scene, refinement.meshes(), own_refine));
    if (off.empty()) break;
    cases::Fem finer = own.resolved;
    finer.refine = refine;
    gave_up = why_not_finer(with_fem(scene, finer), refinement.meshes().solutions.back());
    if (gave_up.empty() && !refinement.add(refine)) gave_up = refinement.meshes().reason;
    if (!gave_up.empty()) break;
  }
  const RefinedMeshes& meshes = refinement.meshes();
  const std::string cost =
      fmt::format("refine = {} to {}, {} unknowns in the last, {:.2f} s in all", meshes.refine.front(),
                  meshes.refine.back(), meshes.solutions.back().unknowns, refinement.seconds());
  told.push_back(off.empty() ? fmt::format("accuracy: reached ({})", cost)
                             : fmt::format("accuracy: not reached: {}; {} ({})", off, gave_up, cost));
  return meshes;
}

} // namespace

double largest_gradient(const cases::Mesh& mesh, const std::vector<Eigen::Vector3d>& displacement,
                        const cases::Sharing* sharing) {
  const cases::Share here = cases::share_here(mesh, sharing);
  double largest = 0;
  for (std::size_t c = here.cells.begin; c < here.cells.end; ++c) {
    const Eigen::Matrix3d gradient =
        deformation_gradient(mesh, c, displacement, here.nodes.begin) - Eigen::Matrix3d::Identity();
    largest = std::max(largest, mechanics::singular_values(gradient)[0]);
  }
  return sharing ? sharing->largest(largest) : largest;
}

double tolerated_error_percent(const cases::Expectation& expectation, double fem) {
  const double width = expectation.interval[1] - expectation.interval[0];
  return expectation.quantity == cases::Quantity::fem ? 100 * width / std::abs(fem) / 4 : width / 4;
}

namespace {

/// Elements that a method steps, and the limit of those that are solved, if asked for.
Answers solve_stepped(const cases::Scene& scene, int n_meshes, const KeptMeshes& kept) {
  const cases::Fem& asked = scene.definition.fem;
  Answers answers;
  answers.resolved = asked;
  if (n_meshes > 0 || asked.has_auto_accuracy) {
    answers = solve_fem(with_solved_fem(scene), n_meshes, kept);
    answers.resolved.real_time = asked.real_time;
    if (!answers.fem.converged())
      answers.refined = RefinedMeshes{{}, {}, "the elements in equilibrium: " + answers.fem.solution.message};
  }
  answers.fem = solve_stepped_fem(with_fem(scene, answers.resolved));
  return answers;
}

} // namespace

Answers solve_fem(const cases::Scene& scene, int n_meshes, const KeptMeshes& kept) {
  cases::check_finite_elements(scene.definition);
  if (scene.definition.fem.real_time) return solve_stepped(scene, n_meshes, kept);
  if (!scene.of_fem.empty()) return solve_fem_at_network(scene, n_meshes);
  const cases::Fem& asked = scene.definition.fem;
  Answers answers;
  answers.resolved = asked;
  if (const auto earlier = kept.find(asked); earlier && !asked.has_auto_formulation) answers.fem = *earlier;
  if (asked.has_auto_formulation) answers = try_small_strain(scene);
  if (!answers.fem.converged()) answers.fem = solve_fem_as_given(scene);
  if ((n_meshes == 0 && !asked.has_auto_accuracy) || scene.definition.stress || !answers.fem.converged())
    return answers;
  if (const auto reason = reason_without_continuum_limit(scene)) {
    answers.refined = RefinedMeshes{{}, {}, *reason};
    return answers;
  }
  kept.keep(answers.resolved, answers.fem);
  if (n_meshes > 0)
    answers.refined = solve_meshes(scene, answers, n_meshes, kept);
  else
    answers.refined = refine_until_known(scene, answers, kept, answers.choices);
  return answers;
}

} // namespace springproof::compare
