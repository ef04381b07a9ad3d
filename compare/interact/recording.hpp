#pragma once

#include "compare/interact/read_recording.hpp"
#include "compare/interact/simulation.hpp"

#include <ostream>

namespace springproof::compare {

/// As read_recording() reads it.
/// @param step  of the case, s
void write_recording(std::ostream& out, const Simulation& simulation, double step);

} // namespace springproof::compare
