#pragma once

#include "compare/thesis/results.hpp"

#include <string>

namespace springproof::compare::html {

/// Case file, settings and command, a line each: what a pointer that rests on a number is shown. Escaped.
std::string provenance(const Trace& trace);

/// A number that shows its command when it is clicked; the bare text where nothing stands behind it.
std::string traced(const std::string& text, const Trace& trace);

} // namespace springproof::compare::html
