#pragma once

#include "compare/sweep/motion_sweep.hpp"
#include "compare/sweep/sweep.hpp"

#include <ostream>

namespace springproof::compare {

/// What a sweep found, on one screen: the fastest of springs and finite elements at several errors, the most
/// accurate in real time, speed against error, and what was not solved. All rows are in the files.
/// @param folder  of `--out`, where they are; empty: none was given, and what to type is told
void write_sweep_screen(std::ostream& out, const Sweep& sweep, const std::string& folder);

/// The same of a sweep in time.
void write_motion_sweep_screen(std::ostream& out, const MotionSweep& sweep, const std::string& folder);

} // namespace springproof::compare
