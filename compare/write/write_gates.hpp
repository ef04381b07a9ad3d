#pragma once

#include "compare/gates/gate.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

/// What the gates said, for people and for machines. Kinds of references are kept apart in each.
namespace springproof::compare {

/// One line per gate (and per failure of a case as a whole), warnings under their gates, and counts per kind.
void write_gates_text(std::ostream& out, const std::vector<GatedCase>& cases);

/// JUnit's XML as continuous-integration servers read it: a test suite per kind of reference, named
/// springproof.KIND, a test case per gate; a gate without a value is an error, one outside its interval a
/// failure. What failed as a whole stands in the suite springproof.cases. Without times, so that the same
/// results make the same file.
void write_gates_junit(std::ostream& out, const std::vector<GatedCase>& cases);

/// {"schema", "program", "machine", "gates": [...], "failures": [...], "kinds": {...}, "met"}
nlohmann::ordered_json gates_to_json(const std::vector<GatedCase>& cases);

/// GitHub's workflow commands: "::error file=...,line=...,title=...::message" for what is not met,
/// "::warning" for warnings.
void write_gates_annotations(std::ostream& out, const std::vector<GatedCase>& cases);

/// How many gates of a kind there are, and how many are met.
struct GateCount {
  cases::ReferenceKind kind;
  int met = 0, all = 0;
};

/// Of the kinds that occur, in the order of their table.
std::vector<GateCount> count_by_kind(const std::vector<GatedCase>& cases);

} // namespace springproof::compare
