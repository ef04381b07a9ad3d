#pragma once

#include "compare/interact/simulation.hpp"

#include <ostream>

namespace springproof::compare {

/// A recording of pulls, one row per step in which something was pulled: step,time,x,y,z,fx,fy,fz. The step
/// is counted from 1, its end is at the time (s); the place is that of the surface at rest (mm), the force in
/// N.
void write_recording(std::ostream& out, const Simulation& simulation, double step);

} // namespace springproof::compare
