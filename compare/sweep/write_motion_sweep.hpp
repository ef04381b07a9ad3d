#pragma once

#include "compare/sweep/motion_sweep.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace springproof::compare {

void write_motion_sweep_text(std::ostream& out, const MotionSweep& sweep);
void write_motion_sweep_csv(std::ostream& out, const MotionSweep& sweep);
nlohmann::ordered_json motion_sweep_to_json(const MotionSweep& sweep);
/// Error against computing per second of motion, log-log: FOLDER/motion_sweep.svg and .png.
/// @throws InputError as draw()
void plot_motion_sweep(const std::string& folder, const MotionSweep& sweep);

} // namespace springproof::compare
