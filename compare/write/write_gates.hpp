#pragma once

#include "compare/gates/comparison.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

/// What the gates said, for people and for machines. Kinds of references are kept apart in each.
namespace springproof::compare {

/// Why a gate is not met; empty when it is.
std::string reason_of(const Gate& gate);

/// A gate in words: "alpha_1 error_percent = -4.98 % in [-6.44, -3.38]", or with the reason why not.
std::string describe(const Gate& gate);

/// What `run` tells of a case's expectations: how many are met, and of the others a line each, "MISSED", or
/// "not judged" of those that need a side that was not asked for.
void write_expectations_text(std::ostream& out, const std::vector<Gate>& gates);

/// The same: [{"measure", "quantity", "interval", "reference", "value", "met", "judged", "undecided",
/// "reason"}, ...]
nlohmann::ordered_json expectations_to_json(const std::vector<Gate>& gates);

/// One line per gate (and per failure of a case as a whole), warnings under their gates, and counts per kind.
void write_gates_text(std::ostream& out, const std::vector<Comparison>& cases);

/// JUnit's XML as continuous-integration servers read it: a test suite per kind of reference, named
/// springproof.KIND, a test case per gate; a gate without a value is an error, one outside its interval a
/// failure. What failed as a whole stands in the suite springproof.cases. Without times, so that the same
/// results make the same file.
void write_gates_junit(std::ostream& out, const std::vector<Comparison>& cases);

/// {"schema", "program", "machine", "gates": [...], "failures": [...], "kinds": {...}, "met"}
nlohmann::ordered_json gates_to_json(const std::vector<Comparison>& cases);

/// GitHub's workflow commands: "::error file=...,line=...,title=...::message" for what is not met,
/// "::warning" for warnings.
void write_gates_annotations(std::ostream& out, const std::vector<Comparison>& cases);

} // namespace springproof::compare
