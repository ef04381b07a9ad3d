#pragma once

#include "compare/solve/answers.hpp"

#include <fmt/format.h>
#include <optional>
#include <string>

/// How long a step of a motion takes, and what that means to whoever watches it.
namespace springproof::compare {

/// Mean over the steps, without the setup; nothing for what did not move to the end.
inline std::optional<double> milliseconds_a_step(const Answer& answer) {
  const auto& motion = answer.solution.trajectory;
  if (!answer.converged() || !motion || motion->time.size() < 2) return std::nullopt;
  return 1e3 * answer.solve_seconds / static_cast<double>(motion->time.size() - 1);
}

/// "8.1 ms a step: keeps 60 Hz": a screen of 60 Hz has a step for each of its pictures.
inline std::string pace_text(double milliseconds_a_step) {
  constexpr double milliseconds_a_picture = 1e3 / 60;
  return fmt::format("{:.2g} ms a step: {} 60 Hz", milliseconds_a_step,
                     milliseconds_a_step <= milliseconds_a_picture ? "keeps" : "does not keep");
}

} // namespace springproof::compare
