#pragma once

#include "compare/gates/comparison.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

/// What a dynamic case has of its time: series of its measures, and bodies.
namespace springproof::compare {

/// One row per measure and step: case,measure,unit,time,fem,msm; times in s, empty where a model has no
/// motion.
void write_motion_csv(std::ostream& out, const Comparison& comparison);

/// The same, and the notes: {"notes": [...], "time": [...], "measures": [{"name", "unit", "fem": [...],
/// "msm": [...]}]}, and of a case with a [surface] how far the models' are apart: "surface": {"time", "fem",
/// "difference", "largest_difference", "error_percent"}; null for a case without motion.
nlohmann::ordered_json motion_to_json(const Comparison& comparison);

/// What steps make of each model's slowest vibration: of the implicit Euler method always, of another scheme
/// where they change it; what the implicit Euler method adds to the damping of every measure that swings;
/// warnings where that is more than the body's own; and a line on how far the surfaces of both models are
/// apart.
std::vector<std::string> notes_on_motion(const Comparison& comparison);

/// FOLDER/NAME_motion.csv, and FOLDER/NAME.pvd, which lists the bodies FOLDER/NAME_motion/NAME_0000.vtu, ...
/// by their times; of a case without motion nothing. On one rank.
/// @throws InputError if a file cannot be written
void write_motion(const std::string& folder, const Comparison& comparison);

} // namespace springproof::compare
