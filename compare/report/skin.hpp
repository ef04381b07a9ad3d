#pragma once

#include "compare/gates/comparison.hpp"

#include <nlohmann/json_fwd.hpp>

namespace springproof::compare {

/// The surface that a case names, at rest and as each model has moved it, for the page's script: {"unit_mm",
/// "rest": [x, y, z, ...], "triangles": [a, b, c, ...], "fem": {"unit_mm", "displacement": [...]}, "springs":
/// {...}, "marks": [{"name", "point"}]}. Lengths are whole numbers of a unit, points and marks in mm. A side
/// without an answer is left out.
/// @return null where the case names no surface, or ranks share the answers
nlohmann::ordered_json skin_to_json(const Comparison& comparison);

} // namespace springproof::compare
