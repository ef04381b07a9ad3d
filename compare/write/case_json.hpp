#pragma once

#include "compare/gates/comparison.hpp"

#include <nlohmann/json_fwd.hpp>

/// Comparisons as JSON. Keys stay in the order written.
namespace springproof::compare {

/// What every document of results begins with: schema, program and machine.
nlohmann::ordered_json provenance();

/// "converged", "failed" or "skipped"; of an answer that was asked for after a number of iterations, and that
/// is no equilibrium, that.
std::string status_of(const cases::Solution& solution);

/// The solution of one side and what it took.
nlohmann::ordered_json side_to_json(const Answer& side);

/// One of its cases.
nlohmann::ordered_json case_to_json(const Comparison& comparison);

/// The document of `run --json`: schema, program, machine and the cases.
nlohmann::ordered_json to_json(const std::vector<Comparison>& comparisons);

} // namespace springproof::compare
