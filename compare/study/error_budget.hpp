#pragma once

#include "compare/gates/comparison.hpp"

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

/// Where the error of a model comes from: its law, its mesh, its steps in time, what iterations leave.
namespace springproof::compare {

/// Part of an error, in percent of the truth.
struct ErrorPart {
  std::optional<double> percent{}; ///< absent: not known
  double uncertainty = 0;          ///< points, left by the limit that the part was measured to
  std::string reason{};            ///< why it is not known, or why it is zero; empty: measured
};

/// The parts of one model's error at one measure. Each is the change of the value when its cause is converged
/// away: `iterations` on the case's mesh and step, `mesh` and `step` each alone with all iterations, and
/// `law` is what is left between the limit in mesh and step and the truth. The step's part is measured once
/// more on the next finer mesh for `law`, so that the sum differs from the whole by what mesh and step do
/// together.
///
/// A part p of a norm of the displacement field counts with p.e/|e|, e the whole difference, so that the
/// parts add up to |e|.
struct ErrorBudget {
  std::string measure;
  ErrorPart law, mesh, step, iterations;
  std::optional<double> whole{}; ///< percent; the truth is the finite elements' limit in mesh and step
  std::string reason{};          ///< why there is no whole; empty when there is one

  /// Sum of the parts, where all are known.
  std::optional<double> sum() const;
  /// Whether parts of opposite sign hide more than half of the error: the sum of their sizes is more than
  /// twice the whole.
  bool cancels() const;
};

/// Names of the parts, in the order of ErrorBudget.
struct NamedPart {
  const char* name;
  ErrorPart ErrorBudget::*part;
  const char* remedy; ///< what makes it smaller
};
extern const std::vector<NamedPart> error_parts;

struct ErrorBudgets {
  std::vector<ErrorBudget> springs, fem; ///< one per measure of the case; empty for a side without an answer
  std::vector<int> lattices;             ///< refinements of the body's mesh that springs were solved on
  std::string note{};                    ///< why there are not three; empty when there are
};

/// The scene on the mesh refined once (cases::refine()), as springs take it: a grid is one again, materials
/// stay with their cells, and the nodes that measures name are those of the body's own mesh.
/// @throws InputError as cases::refine()
cases::Scene finer_lattice(const cases::Scene& scene);

/// Solves the springs of a compared case on lattices of half and a quarter of the width, and both models of a
/// motion with half the step. Springs run in this process.
/// @param comparison  on one rank, with our own springs
/// @return a note and no budgets where a model has no answer
ErrorBudgets study_errors(const Comparison& comparison, const Request& request);

/// Whether springs are left where a given number of iterations has brought them.
bool has_iteration_limit(const cases::Msm& msm);

/// The springs of a case at rest on its own and finer lattices, which all answers by these springs share.
class SpringLattices {
 public:
  /// @param solved  compared in equilibrium, on one rank
  SpringLattices(const Comparison& solved, const Request& request);
  /// Parts of the error of an answer by these springs at a measure of the case.
  /// @param is_solved  nothing is left by iterations, and by steps on which a place of rest depends
  ErrorBudget budget_of(const Comparison& answer, const std::string& measure, bool is_solved) const;

 private:
  struct All;
  std::shared_ptr<const All> all_;
};

/// Parts of the error of elements that a method of [fem] real_time has brought to rest, at a measure of the
/// case. Solves the elements in equilibrium.
/// @param stepped  compared with the truth, its finite elements the method's
ErrorBudget budget_of_stepped_elements(const Comparison& stepped, const std::string& measure);

/// A table of both models, and a sentence on the worst measure of the springs: its parts, whether they
/// cancel, what to change first.
void write_error_budget_text(std::ostream& out, const ErrorBudgets& budgets);

/// "+1.20 +- 0.3"; "0" of what is zero by construction, "-" of what is not known.
std::string part_text(const ErrorPart& part);

/// {"measure", "law": {"percent", "uncertainty", "reason"}, "mesh", "step", "iterations", "sum", "whole",
/// "cancels", "reason"}
nlohmann::ordered_json error_budget_to_json(const ErrorBudget& budget);

/// {"lattices", "note", "advice": [sentences], "msm": [budgets], "fem": [budgets]}
nlohmann::ordered_json error_budgets_to_json(const ErrorBudgets& budgets);

} // namespace springproof::compare
