#pragma once

#include "compare/gates/comparison.hpp"

#include <ostream>

namespace springproof::compare {

/// Both sides, warnings, the peer, measures, the mesh study and the expectations.
void write_text(std::ostream& out, const Comparison& comparison);

} // namespace springproof::compare
