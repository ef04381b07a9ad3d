#pragma once

#include "mechanics/real_time/coming_to_rest.hpp"
#include "msm/model.hpp"

/// Springs that simulators' methods move.
namespace springproof::msm {

/// The method of [msm] real_time, as a motion on the direct path takes it.
/// @param problem  the motion's, must outlive this
/// @throws cases::InputError where the method cannot take the springs
MovingSprings::StepMethod step_method(const cases::RealTime& real_time, const Problem& problem,
                                      int n_threads);

/// Settings of a motion that is stepped so: substeps, and no step is halved.
/// @param step  s, that the substeps are of
mechanics::IntegrationSettings in_substeps(const cases::Scene& scene, const SpringBody& springs, double step);

/// The scene of a body without [dynamics] as the motion in which it comes to rest.
cases::Scene in_motion(cases::Scene scene);

/// Where a body without [dynamics] comes to rest: its whole loads act from time 0 on, and its supports are at
/// once where they go.
/// @return with Solution::from_equilibrium but for the distances
/// @throws cases::SolveError when it is stopped, or does not come to rest within the time that the case gives
cases::Solution come_to_rest(const cases::Scene& scene, const SpringBody& springs, int n_threads,
                             const mechanics::StepLimits& limits = {});

} // namespace springproof::msm
