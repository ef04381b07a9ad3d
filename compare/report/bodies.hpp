#pragma once

#include "compare/error_bars/convergence.hpp"
#include "compare/thesis/figures.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace springproof::compare {

/// One body of a page, to be turned.
struct BodyView {
  std::string id;      ///< id of the element on the page
  Overlay overlay;     ///< its title stands below the body
  std::string group{}; ///< heading over the bodies that have the same
  std::string description{}, command{};
  std::vector<MeasuredValue> measures{};
  std::vector<std::string> failures{}; ///< why a side is not drawn
};

/// A case's own view. A side that failed is left out, with the reason.
/// @param overlay  overlay of both sides
BodyView view_of(const Comparison& comparison, const std::string& id, Overlay overlay);

/// The views' geometry for the page's script: {"bodies": [{"unit_mm", "rest": [x, y, z, ...], "faces": [a, b,
/// c, d, ...]}], "views": [{"id", "largest_scale", "title", "group", "description", "command", "measures",
/// "failures", "fem": {"body", "unit_mm", "displacement": [...]}, "springs": {...}}]}. Lengths are whole
/// numbers of a unit that leaves them five digits. Bodies are surfaces alone, and views of the same body
/// share it. A side without an answer is left out.
nlohmann::ordered_json views_to_json(const std::vector<BodyView>& views);

/// The surface that a case names, at rest and as each model has moved it, for the page's script: {"unit_mm",
/// "rest": [x, y, z, ...], "triangles": [a, b, c, ...], "fem": {"unit_mm", "displacement": [...]}, "springs":
/// {...}, "marks": [{"name", "point"}]}. Lengths are whole numbers of a unit, points and marks in mm. A side
/// without an answer is left out.
/// @return null where the case names no surface, or ranks share the answers
nlohmann::ordered_json skin_to_json(const Comparison& comparison);

} // namespace springproof::compare
