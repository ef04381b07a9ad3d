#pragma once

#include "cases/case/solution.hpp"
#include "mechanics/dynamics/dynamic_problem.hpp"

namespace springproof::mechanics {

/// The slowest of the small vibrations about a state, without damping: omega² M x = K x.
/// Inverse iteration on K + shift M, shift = 1/seconds², with the problem's own solver of steps.
/// Motions that take longer than 3 times `seconds` for a radian, rigid ones among them, are no vibrations
/// here and are left out.
/// @param at       displacement, mm, where the tangent K is taken   @param seconds  the motion's length, > 0
/// @return omega (1/s) to about 1 %, and the damping ratio x.Cx/(2 omega x.Mx) of the shape; nothing where a
/// linear solver fails or there is no such vibration. The problem's step is changed.
std::optional<cases::Vibration> slowest_vibration(DynamicProblem& problem, const Vector& at, double seconds);

} // namespace springproof::mechanics
