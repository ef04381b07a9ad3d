#pragma once

#include "compare/solve/springs.hpp"
#include "compare/sweep/sweep.hpp"

/// Springs, or finite elements, that a simulators' method steps, for a sweep at a rate.
namespace springproof::compare {

/// A model on a mesh.
struct SteppedBody {
  Variant variant;
  cases::Scene scene;
  msm::SpringBody springs{};                      ///< none where elements are stepped
  std::optional<double> in_equilibrium_percent{}; ///< error of the springs' field; of a body at rest
};

/// Gives a sweep's case steps of a frame, and notes what of it they ignore.
/// @return the step of a motion's reference, s: a whole part of a frame, no longer than the case's own
/// @throws InputError where the case cannot be stepped
double set_frames(Sweep& sweep);

/// What a method is tried with; an explicit one has as many substeps as are stable.
/// @param given  the steps of a body that is to come to rest
std::vector<Steps> steps_to_try(const AnyMethod& method, const cases::RealTime& given);

/// Frames that a method is tried by, at least two.
constexpr int n_first_frames = 3;

/// Times the frames after the first, which makes what the others keep, from the start of the body's motion.
/// @param n_frames  fewer are made where they would take more than two seconds
/// @return seconds of each
/// @throws InputError where the method cannot take the body; SolveError
std::vector<double> time_frames(const SteppedBody& body, const Steps& steps, int n_frames);

/// Where a body is after a time.
struct Rest {
  /// Failed where a step is not solved or the body flies off; converged at rest; skipped where it still moves
  /// and its mean is wanted.
  cases::Solution solution;
  /// Largest way of a node in the last half second, percent of the largest displacement.
  double moves_percent = 0;
};

/// @param within  s, at least half a second
Rest rest_within(const SteppedBody& body, const Steps& steps, double within,
                 mechanics::StillMoving still_moving);

/// The motion of a body until a time.
cases::Solution moved_until(const SteppedBody& body, const Steps& steps, double end);

} // namespace springproof::compare
