#pragma once

#include "compare/solve/springs.hpp"
#include "compare/sweep/sweep.hpp"

/// Springs that a method of [msm] real_time steps, for a sweep at a rate.
namespace springproof::compare {

/// The springs of a design on a mesh.
struct DesignedBody {
  Variant variant;
  cases::Scene scene;
  msm::SpringBody springs;
  std::optional<double> in_equilibrium_percent{}; ///< error of the field; of a body at rest
};

/// What each method is tried with; symplectic Euler has as many substeps as are stable.
/// @param given  the steps of a body that is to come to rest
std::vector<cases::RealTime> steps_to_try(const cases::RealTime& given);

/// Frames that a method is tried by, at least two.
constexpr int n_first_frames = 3;

/// Times the frames after the first, which makes what the others keep, from the start of the body's motion.
/// @param n_frames  fewer are made where they would take more than two seconds
/// @return seconds of each
/// @throws InputError where the method cannot take the springs; SolveError
std::vector<double> time_frames(const DesignedBody& body, const cases::RealTime& steps, int n_frames);

/// Where a body is after a time.
struct Rest {
  /// Failed where a step is not solved or the body flies off; converged at rest; skipped where it still moves
  /// and its mean is wanted.
  cases::Solution solution;
  /// By which a node has moved in the last half second, of the largest displacement.
  double moves_percent = 0;
};

/// @param within  s, at least half a second
Rest rest_within(const DesignedBody& body, const cases::RealTime& steps, double within,
                 mechanics::StillMoving still_moving);

/// The motion of a body until a time.
cases::Solution moved_until(const DesignedBody& body, const cases::RealTime& steps, double end);

} // namespace springproof::compare
