#pragma once

#include "compare/thesis/regenerate.hpp"

#include <ostream>

namespace springproof::compare {

/// Everything behind the tables: each figure against each reference, what is known of those that are not met,
/// and the command that repeats it; then designs, volumes, advice and the counts. Its lines are as long as
/// they come. No times, dates or machine's name: the same commit writes the same bytes.
void write_audit_text(std::ostream& out, const ThesisResults& results);

} // namespace springproof::compare
