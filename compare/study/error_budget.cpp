#include "compare/study/error_budget.hpp"

#include "cases/case/elements.hpp"
#include "compare/error_bars/convergence.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/springs.hpp"
#include "compare/study/measured_parts.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

bool has_iteration_limit(const cases::Msm& msm) {
  return msm.iterations_per_step || msm.real_time || msm.relaxation;
}

namespace {

using cases::index;
using Eigen::Vector3d;

/// The springs with nothing left that iterations leave.
cases::Scene without_iteration_limit(cases::Scene scene) {
  cases::Msm& msm = scene.definition.msm;
  msm.iterations_per_step.reset();
  msm.real_time.reset();
  if (msm.relaxation) {
    msm.relaxation.reset();
    msm.solver = cases::Solver::newton;
  }
  return scene;
}

/// What a lattice is left unsolved for.
constexpr double most_seconds = 60;

std::string why_not_finer(const cases::Scene& finer, const Request& request) {
  const Estimate next = estimate_springs(size_of(finer));
  const MemoryLimit limit = memory_limit();
  if (next.seconds <= most_seconds * request.n_threads && megabytes_within(limit, next) <= limit.megabytes)
    return "";
  return fmt::format("the next lattice would have about {:.2g} unknowns, and take {:.0f} s and {:.0f} MB",
                     next.unknowns, next.seconds, next.megabytes);
}

/// Why a case's springs are those of its own mesh alone; empty when others can be designed like them.
std::string why_one_lattice(const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  if (cases::facts_of(definition.msm.design).source == cases::DesignSource::file)
    return "the springs of a file belong to its mesh, and have no limit";
  return reason_without_continuum_limit(comparison.scene).value_or("");
}

Answer solved(const cases::Scene& scene, const Request& request) {
  std::optional<msm::DesignResult> unused;
  return solve_springs(scene, request.n_threads, unused);
}

/// The springs of a case, without what iterations leave, on lattices from coarse to fine.
class Lattices {
 public:
  Lattices(const Comparison& comparison, const Request& request, ErrorBudgets& told)
      : request_(request), told_(told) {
    constexpr int most = 3;
    cases::Scene scene = without_iteration_limit(comparison.scene);
    const std::string one = why_one_lattice(comparison);
    const bool is_own = !has_iteration_limit(comparison.scene.definition.msm);
    while (add(std::move(scene), is_own && all.empty() ? &comparison.answers.msm.solution : nullptr)) {
      told_.lattices.push_back(static_cast<int>(all.size()) - 1);
      if (!(told_.note = one).empty() || all.size() == most) return;
      try {
        scene = finer_lattice(all.back().scene);
      } catch (const cases::InputError& error) {
        told_.note = error.what();
        return;
      }
      if (!(told_.note = why_not_finer(scene, request)).empty()) return;
    }
  }

  std::vector<SolvedLattice> all;

 private:
  const Request& request_;
  ErrorBudgets& told_;

  /// Solves one more lattice; of a motion the first two with half the step too.
  bool add(cases::Scene scene, const cases::Solution* known) {
    SolvedLattice lattice{std::move(scene), {}};
    if (!is_solved(known ? Answer{*known} : solved(lattice.scene, request_), lattice.solution)) return false;
    if (lattice.scene.definition.dynamics && all.size() < 2 &&
        !is_solved(solved(with_half_the_step(lattice.scene), request_), lattice.half_step.emplace()))
      return false;
    all.push_back(std::move(lattice));
    return true;
  }

  bool is_solved(Answer answer, cases::Solution& solution) {
    if (!answer.converged())
      told_.note =
          fmt::format("the lattice refined {} times was not solved: {}", all.size(), answer.solution.message);
    solution = std::move(answer.solution);
    return answer.converged();
  }
};

/// The finite elements on the case's mesh with every equation solved.
struct SolvedFem {
  cases::Solution solution;
  std::optional<cases::Solution> half_step{}; ///< there in motions
  std::optional<cases::Solution> other_law{}; ///< by the law that a method of steps has of its own
  std::string no_other_law{};                 ///< why it is not known; empty where it is, or there is none
  bool has_other_law() const { return other_law.has_value(); }
};

/// Adds what a method's own law comes to, which is not that of the case.
void add_other_law(const Comparison& comparison, SolvedFem& solved) {
  const auto& real_time = comparison.scene.definition.fem.real_time;
  if (!real_time || real_time->method == cases::ElementMethod::total_lagrangian_explicit) return;
  if (comparison.scene.definition.dynamics) {
    Answer found = solve_stepped_fem(comparison.scene, fem_reference::StepBy::newton);
    if (!found.converged())
      solved.no_other_law = found.solution.message;
    else
      solved.other_law = std::move(found.solution);
    return;
  }
  const cases::Solution& rest = comparison.answers.fem.solution;
  const auto& from = rest.from_equilibrium;
  if (!from || !from->largest) {
    solved.no_other_law = from ? from->reason : "the elements did not come to rest";
    return;
  }
  solved.other_law = rest;
  solved.other_law->displacement = from->displacement;
  msm::measure_cells(comparison.scene.mesh, *solved.other_law);
}

/// @param told  gets the reason where there is no answer
std::optional<SolvedFem> solved_fem(const Comparison& comparison, std::string& told) {
  const Answers& answers = comparison.answers;
  SolvedFem solved{answers.fem.solution};
  const auto solve = [&](cases::Scene scene, const char* how) -> std::optional<cases::Solution> {
    Answer answer = solve_fem_as_given(with_solved_fem(with_fem(std::move(scene), answers.resolved)));
    if (answer.converged()) return std::move(answer.solution);
    told = fmt::format("the finite elements {}: {}", how, answer.solution.message);
    return std::nullopt;
  };
  if (comparison.scene.definition.fem.real_time) {
    auto all = solve(comparison.scene, "in equilibrium");
    if (!all) return std::nullopt;
    solved.solution = std::move(*all);
  }
  if (comparison.scene.definition.dynamics) {
    solved.half_step = solve(with_half_the_step(comparison.scene), "with half the step");
    if (!solved.half_step) return std::nullopt;
  }
  add_other_law(comparison, solved);
  return solved;
}

const char* const by_construction = "zero by construction";

/// The parts of both models' errors at one measure.
class Budget {
 public:
  Budget(const cases::Measure& measure, const Comparison& comparison)
      : measure_(measure), scene_(comparison.scene), answers_(comparison.answers),
        parts_(measure, comparison.scene),
        order_(comparison.scene.definition.dynamics ? order_in_time(comparison.scene) : 1) {}

  /// Finds the truth, the finite elements' limit in mesh and step.
  /// @return why there is none; empty when there is one
  std::string find_truth(const std::optional<MeshStudy>& study, const SolvedFem& solved) {
    if (cases::is<cases::measures::DisplacementFieldMax>(measure_))
      return "the largest displacements of two bodies are at two places, and parts of them do not add up";
    if (is_trajectory_norm(measure_)) return "the norm of a course over time has no parts that add up";
    if (!study) return "the case has accuracy = \"none\", so no limit is known (--converge asks for it)";
    const StudiedMeasure& studied = *find_named(study->measures, measure_.name);
    if (!studied.reference) return studied.no_reference;
    limit_ = is_field_norm(measure_.kind) ? Known{study->field->value, study->field->uncertainty}
                                          : MeasuredParts::of_number(*studied.reference);
    const auto value = parts_.value(scene_, solved.solution);
    if (!value) return "the finite elements have no such value";
    fem_ = *value;
    fem_step_ = zero();
    if (solved.half_step) {
      const auto half = parts_.value(scene_, *solved.half_step);
      if (!half) return "the finite elements have no such value with half the step";
      fem_step_ = step_part(fem_, *half, order_);
    }
    truth_ = difference(limit_.value, fem_step_);
    if (!(parts_.size(truth_) > zero_of(measure_, scene_, answers_.fem.solution)))
      return "the truth is zero, and errors are relative to it";
    return "";
  }

  ErrorBudget of_fem(const SolvedFem& solved) {
    const auto own = parts_.value(scene_, answers_.fem.solution);
    if (!own) return {measure_.name, {}, {}, {}, {}, {}, "the finite elements have no such value"};
    whole_ = difference(*own, truth_);
    ErrorBudget budget = begin();
    budget.law = budget.iterations = {0., 0, by_construction};
    budget.mesh = part(difference(fem_, limit_.value), limit_.uncertainty);
    budget.step = step(fem_step_);
    if (!scene_.definition.fem.real_time) return budget;
    const auto all = solved.has_other_law() ? parts_.value(scene_, *solved.other_law) : fem_;
    if (solved.no_other_law.empty() && all) {
      if (solved.has_other_law()) budget.law = part(difference(*all, fem_), zero());
      budget.iterations = part(difference(*own, *all), zero());
    } else {
      budget.law = budget.iterations = {std::nullopt, 0, solved.no_other_law};
    }
    return budget;
  }

  /// @param is_solved  nothing is left by iterations
  ErrorBudget of_springs(const std::vector<SolvedLattice>& lattices, const std::string& note,
                         bool is_solved) {
    const auto own = parts_.value(scene_, answers_.msm.solution);
    if (!own) return {measure_.name, {}, {}, {}, {}, {}, "the springs have no such value"};
    whole_ = difference(*own, truth_);
    ErrorBudget budget = begin();
    std::vector<Field> values, steps;
    for (const SolvedLattice& lattice : lattices) {
      const auto value = parts_.value(lattice.scene, lattice.solution);
      if (!value) break;
      values.push_back(*value);
      if (!lattice.half_step) continue;
      const auto half = parts_.value(lattice.scene, *lattice.half_step);
      if (!half) break;
      steps.push_back(step_part(*value, *half, order_));
    }
    const auto unknown = [&](const std::string& why) { return ErrorPart{std::nullopt, 0, why}; };
    if (values.empty()) {
      budget.law = budget.mesh = budget.step = budget.iterations = unknown(note);
      return budget;
    }
    budget.iterations =
        is_solved ? ErrorPart{0., 0, by_construction} : part(difference(*own, values.front()), zero());
    const bool moves = scene_.definition.dynamics.has_value();
    budget.step = moves && steps.empty() ? unknown(note) : step(moves ? steps.front() : zero());
    const auto limit = values.size() == 1 ? note : parts_.limit(values);
    if (const auto* reason = std::get_if<std::string>(&limit)) {
      budget.law = budget.mesh = unknown(*reason);
      return budget;
    }
    const Known& lattice = std::get<Known>(limit);
    budget.mesh = part(difference(values.front(), lattice.value), lattice.uncertainty);
    if (moves && steps.size() < 2) {
      budget.law = unknown(note);
      return budget;
    }
    const Field at_rest = moves ? difference(lattice.value, steps.back()) : lattice.value;
    budget.law = part(difference(at_rest, truth_), lattice.uncertainty);
    budget.law.uncertainty += 100 * parts_.size(limit_.uncertainty) / parts_.size(truth_);
    return budget;
  }

 private:
  const cases::Measure& measure_;
  const cases::Scene& scene_;
  const Answers& answers_;
  MeasuredParts parts_;
  int order_;
  Known limit_;
  Field fem_, fem_step_, truth_, whole_;

  Field zero() const { return Field(fem_.size(), Vector3d::Zero()); }

  ErrorBudget begin() const {
    return {measure_.name, {}, {}, {}, {}, parts_.percent(whole_, whole_, truth_), {}};
  }

  ErrorPart part(const Field& change, const Field& uncertainty) const {
    return {parts_.percent(change, whole_, truth_), 100 * parts_.size(uncertainty) / parts_.size(truth_), {}};
  }

  ErrorPart step(const Field& change) const {
    return scene_.definition.dynamics ? part(change, zero()) : ErrorPart{0., 0, by_construction};
  }
};

} // namespace

cases::Scene finer_lattice(const cases::Scene& scene) {
  cases::Scene own = scene;
  for (cases::Measure& measure : own.definition.measures)
    cases::for_each_region(measure, [&](cases::Region& region, bool) {
      if (!region.is_node()) return;
      region.near = Vector3d(scene.mesh.nodes[cases::index(cases::select_node(scene.mesh, region))]);
      region.tolerance.reset();
    });
  cases::Scene fine = cases::refine(own, 1);
  if (!scene.mesh.grid) return fine;
  // The search for a grid puts the cells in another order, and takes their groups along: the material's
  // number stands behind the group's name meanwhile.
  std::vector<std::string>& groups = fine.mesh.group_of_cell;
  const bool has_groups = !groups.empty(), has_materials = !fine.material_of_cell.empty();
  if (has_materials) {
    groups.resize(fine.mesh.cells.size());
    for (std::size_t c = 0; c < groups.size(); ++c)
      groups[c] += '\n' + std::to_string(fine.material_of_cell[c]);
  }
  cases::find_grid(fine.mesh);
  for (std::size_t c = 0; has_materials && c < groups.size(); ++c) {
    const std::size_t end = groups[c].rfind('\n');
    fine.material_of_cell[c] = std::stoi(groups[c].substr(end));
    groups[c].resize(end);
  }
  if (!has_groups) groups.clear();
  if (auto* box = std::get_if<cases::Box>(&fine.definition.body))
    for (int& n : box->cells) n *= 2;
  return fine;
}

const std::vector<NamedPart> error_parts{
    {"law", &ErrorBudget::law, "another design"},
    {"mesh", &ErrorBudget::mesh, "finer cells"},
    {"step", &ErrorBudget::step, "a shorter step"},
    {"iterations", &ErrorBudget::iterations, "more iterations"},
};

std::optional<double> ErrorBudget::sum() const {
  double total = 0;
  for (const NamedPart& named : error_parts) {
    const std::optional<double>& percent = (this->*named.part).percent;
    if (!percent) return std::nullopt;
    total += *percent;
  }
  return total;
}

bool ErrorBudget::cancels() const {
  double sizes = 0;
  for (const NamedPart& named : error_parts) sizes += std::abs((this->*named.part).percent.value_or(0));
  return whole && sizes > 2 * std::abs(*whole);
}

ErrorBudgets study_errors(const Comparison& comparison, const Request& request) {
  const Answers& answers = comparison.answers;
  ErrorBudgets budgets;
  if (!answers.fem.converged() || !answers.msm.converged()) {
    budgets.note = "a model has no answer";
    return budgets;
  }
  const std::optional<SolvedFem> solved = solved_fem(comparison, budgets.note);
  if (!solved) return budgets;
  const std::vector<SolvedLattice> lattices = Lattices(comparison, request, budgets).all;
  const bool is_solved = !has_iteration_limit(comparison.scene.definition.msm);
  for (const cases::Measure& measure : comparison.scene.definition.measures) {
    Budget budget(measure, comparison);
    const std::string why = budget.find_truth(comparison.mesh_study, *solved);
    const ErrorBudget none{measure.name, {}, {}, {}, {}, {}, why};
    budgets.springs.push_back(why.empty() ? budget.of_springs(lattices, budgets.note, is_solved) : none);
    budgets.fem.push_back(why.empty() ? budget.of_fem(*solved) : none);
  }
  return budgets;
}

ErrorBudget budget_of_stepped_elements(const Comparison& stepped, const std::string& measure) {
  std::string why;
  const std::optional<SolvedFem> solved = solved_fem(stepped, why);
  Budget budget(*find_named(stepped.scene.definition.measures, measure), stepped);
  if (solved) why = budget.find_truth(stepped.mesh_study, *solved);
  return why.empty() ? budget.of_fem(*solved) : ErrorBudget{measure, {}, {}, {}, {}, {}, why};
}

struct SpringLattices::All {
  std::vector<SolvedLattice> lattices;
  std::string note;
};

SpringLattices::SpringLattices(const Comparison& solved, const Request& request)
    : all_([&] {
        auto all = std::make_shared<All>();
        ErrorBudgets told;
        all->lattices = Lattices(solved, request, told).all;
        all->note = told.note;
        return all;
      }()) {}

ErrorBudget SpringLattices::budget_of(const Comparison& answer, const std::string& measure,
                                      bool is_solved) const {
  Budget budget(*find_named(answer.scene.definition.measures, measure), answer);
  const std::string why = budget.find_truth(answer.mesh_study, SolvedFem{answer.answers.fem.solution});
  if (!why.empty()) return {measure, {}, {}, {}, {}, {}, why};
  return budget.of_springs(all_->lattices, all_->note, is_solved);
}

} // namespace springproof::compare
