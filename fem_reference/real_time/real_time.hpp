#pragma once

#include "cases/case/solution.hpp"
#include "cases/case/steps_by.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/real_time/coming_to_rest.hpp"
#include "mechanics/real_time/points_in_time.hpp"

#include <memory>
#include <vector>

/// Finite elements that simulators' methods move.
namespace springproof::fem_reference {

/// Who solves a step's equation.
enum class StepBy { method, newton };

/// The elements of a scene on the mesh that [fem] refine asks for, with lumped masses. Its solutions are of
/// the body's own nodes.
class SteppedElements {
 public:
  /// @param scene  must outlive this
  /// @throws cases::InputError where a step cannot be made stable
  SteppedElements(const cases::Scene& scene, const cases::ElementRealTime& real_time, int n_threads);
  ~SteppedElements();

  /// The motion through the time of [dynamics].
  /// @param start  displacement of the body's own nodes, mm; empty: rest
  /// @param by     newton: of the method's law, in one substep a step unless that is explicit
  /// @throws cases::SolveError with the time reached, when it is stopped too
  cases::Solution follow(const std::vector<Eigen::Vector3d>& start, StepBy by = StepBy::method,
                         const mechanics::StepLimits& limits = {});
  /// Where the body comes to rest: its whole loads act from time 0 on, and its supports are at once where
  /// they go.
  /// @return with Solution::from_equilibrium but for the distances
  /// @throws cases::SolveError when it is stopped, or does not come to rest within the time that the case
  /// gives it
  cases::Solution come_to_rest(const mechanics::StepLimits& limits = {});
  /// What an integrator steps, for as long as this lives: vectors have three entries for each node of the
  /// mesh that [fem] refine asks for, the body's own nodes first.
  mechanics::PointsInTime& points();
  /// How: in how many substeps.
  mechanics::IntegrationSettings settings();
  /// The displacement of the body's own nodes (mm) in the equilibrium of the method's law near where it came
  /// to rest.
  /// @throws cases::SolveError when there is none
  std::vector<Eigen::Vector3d> equilibrium();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace springproof::fem_reference
