#pragma once

#include "cases/case/case.hpp"

/// Ways of supports between two times of a motion: their histories may have factors above 1 and below 0.
namespace springproof::cases {

/// Degrees in one step of the load or of time. Where a turned support ends says nothing about whole turns:
/// only small steps lead the body around with it. A straight guess then leaves the arc by 15 % of the radius.
constexpr double largest_turn_of_step = 30;

constexpr double most_time_steps = 1e7; ///< per case

/// The smallest and the largest factor of a history from one time to another (s), ends included.
std::array<double, 2> factors_between(const History& history, double begin, double end);

/// The factor with the largest magnitude in a whole motion; 1 in a static case.
double largest_factor(const Moved& moved, const std::optional<Dynamics>& dynamics);

/// @throws InputError for a region that turns by more than largest_turn_of_step within a step in time, with
/// the largest step that is short enough
void check_turns_in_time(const Case& definition);

} // namespace springproof::cases
