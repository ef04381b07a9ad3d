#pragma once

#include "compare/gates/comparison.hpp"
#include "compare/write/write_fields.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

/// One plain record (Comparison), many writers.
namespace springproof::compare {

/// Both sides, warnings, the peer, measures, the mesh study and the expectations.
void write_text(std::ostream& out, const Comparison& comparison);

/// What every document of results begins with: schema, program and machine.
nlohmann::ordered_json provenance();

/// The solution of one side and what it took.
nlohmann::ordered_json side_to_json(const Answer& side);

/// One of its cases.
nlohmann::ordered_json case_to_json(const Comparison& comparison);

/// The document of `run --json`: schema, program, machine and the cases. Keys stay in the order written.
nlohmann::ordered_json to_json(const std::vector<Comparison>& comparisons);

/// One row per case and measure: case,measure,unit,fem,msm,error_percent,fem_status,msm_status,
/// fem_discretisation_error_percent,peer,reference,fem_limit,fem_limit_uncertainty,error_uncertainty_percent,
/// error_same_mesh_percent; empty where there is no value.
void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons);

/// The files of `--out`: results.json and comparison.csv of all cases, and fields and motion of the last one.
/// Called after every case, so that what is finished is on disk before the next begins; by every rank.
/// @param done  at least one
void write_results(const std::string& folder, const std::vector<Comparison>& done);

} // namespace springproof::compare
