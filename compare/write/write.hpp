#pragma once

#include "compare/gates/comparison.hpp"
#include "compare/write/case_json.hpp"
#include "compare/write/write_fields.hpp"
#include "compare/write/write_text.hpp"

#include <ostream>

/// One plain record (Comparison), many writers.
namespace springproof::compare {

/// One row per case and measure: case,measure,unit,fem,msm,error_percent,fem_status,msm_status,
/// fem_discretisation_error_percent,peer,reference,fem_limit,fem_limit_uncertainty,error_uncertainty_percent,
/// error_same_mesh_percent; empty where there is no value.
void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons);

/// The files of `--out`: results.json and comparison.csv of all cases, and fields and motion of the last one.
/// Called after every case, so that what is finished is on disk before the next begins; by every rank.
/// @param done  at least one
void write_results(const std::string& folder, const std::vector<Comparison>& done);

} // namespace springproof::compare
