#pragma once

#include "compare/thesis/plot_bodies.hpp"
#include "compare/thesis/regenerate.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace springproof::compare {

/// One three-dimensional view of the report.
struct BodyView {
  std::string id; ///< of the element on the page; the case's name
  Overlay overlay;
};

/// One view for each case, in their order. The bars' springs all stand against the finest bar's finite
/// elements.
std::vector<BodyView> body_views(const ThesisResults& results);

/// The views' geometry for the page's script: {"unit_mm": 1e-4, "bodies": [{"rest": [x, y, z, ...], "faces":
/// [a, b, c, d,
/// ...]}], "views": [{"id", "largest_scale", "fem": {"body", "displacement": [...]}, "springs": {...}}]}.
/// Lengths are whole numbers of the unit. Bodies are surfaces alone, and views of the same body share it. A
/// side without an answer is left out.
nlohmann::ordered_json views_to_json(const std::vector<BodyView>& views);

} // namespace springproof::compare
