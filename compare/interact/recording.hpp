#pragma once

#include "compare/interact/simulation.hpp"

#include <ostream>

namespace springproof::compare {

inline const std::string recording_header = "step,time,x,y,z,radius,fx,fy,fz";

/// A recording of pulls, one row per step in which something was pulled: step,time,x,y,z,radius,fx,fy,fz. The
/// step is counted from 1, its end is at the time (s); the place is the part of the surface within a sphere,
/// of which are told the centre and the radius at rest (mm); the force in N.
void write_recording(std::ostream& out, const Simulation& simulation, double step);

} // namespace springproof::compare
