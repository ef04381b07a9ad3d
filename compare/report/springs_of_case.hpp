#pragma once

#include "compare/gates/comparison.hpp"

#include <nlohmann/json_fwd.hpp>

namespace springproof::compare {

/// What a case's own springs are: as attempt_to_json() of compare/cube has a design, with "design", its name,
/// and "kinds_of_cells", how many cells have springs of their own (0: all are alike). Null without a design
/// of ours. A network has no moduli: they are null.
nlohmann::ordered_json springs_of_case(const Comparison& comparison);

} // namespace springproof::compare
