#pragma once

#include "cases/scene/scene.hpp"
#include "compare/table/json.hpp"

#include <ostream>

/// What both models of a case have in common: the body and its loads.
namespace springproof::compare {

/// The body's size, so that one in metres is told from one in millimetres; the loads as one force and one
/// moment, unless a load follows a history; the areas that loads and motions act on.
void write_scene_text(std::ostream& out, const cases::Scene& scene);

/// {"size_mm", "volume_mm3", "cells", "nodes"}
nlohmann::ordered_json body_to_json(const cases::Scene& scene);

/// {"force_N", "moment_N_mm", "about_mm" (null where a load follows a history), "areas_mm2": {"load[0]":
/// ...}}
nlohmann::ordered_json loads_to_json(const cases::Scene& scene);

} // namespace springproof::compare
