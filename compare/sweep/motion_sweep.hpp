#pragma once

#include "cases/case/case.hpp"
#include "cases/case/solution.hpp"
#include "compare/sweep/plan.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Speed against error in time: springs and finite elements of a dynamic case, at several resolutions and
/// steps.
namespace springproof::compare {

/// The steps that a sweep in time takes, in those of the case.
constexpr std::array<double, 3> step_factors{2, 1, 0.5};

/// One motion: what it took, and how far its watched nodes are from the reference's.
struct MotionRow {
  std::string method;
  std::optional<cases::Design> design{}; ///< of springs; nothing: finite elements
  std::array<int, 3> cells{};
  double step = 0; ///< s
  cases::Status status{};
  std::string message{};
  std::size_t unknowns = 0;
  double seconds_per_second =
      0; ///< of computing for a second of motion; one run, one thread, without setting up
  std::optional<double> error_percent{}; ///< finite; absent when it failed
  Family family() const { return design ? Family::springs : Family::finite_elements; }
};

struct MotionSweep {
  cases::Case definition;
  std::string reference;
  double uncertainty_percent = 0; ///< what the last halvings of its cells and of its step changed, together
  std::vector<MotionRow> rows;
  std::vector<LeftOut> left_out;
  std::vector<std::string> settings{}; ///< what `--set` has set in the definition
};

/// Whether any motion beside the reference was followed to its end.
bool has_answer(const MotionSweep& sweep);

/// Springs of the designs that a sweep takes (springs_to_sweep()), the case's own with its settings and the
/// others with their defaults, and the case's finite elements, on levels_of() its body, with twice, once and
/// half the case's step or with that one alone, against the finite-strain motion on the finest level by
/// generalized_alpha with a quarter of the step. One after the other in this process.
/// @param on_row  called with the sweep as it is after every motion
/// @throws InputError for a body that is no box, a case without measures of nodes, or with nodes that a level
/// has not or that do not move; SolveError when the reference fails
MotionSweep sweep_motion(const cases::Case& definition, Extent extent,
                         const std::function<void(const MotionSweep&)>& on_row);

/// Difference of two motions of equal nodes at the times of the second that both have, percent of the
/// first's: root mean squares over times and nodes.
std::optional<double> motion_error_percent(const cases::Trajectory& reference,
                                           const cases::Trajectory& other);

} // namespace springproof::compare
