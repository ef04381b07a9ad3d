#pragma once

#include "compare/gates/comparison.hpp"

namespace springproof::compare {

/// Everything that the program warns of in a case's result, a sentence each: about the loads, the files that
/// the body is made from, another program's displacements, and the design of the springs. Warnings about
/// steps in time are in notes_on_motion().
std::vector<std::string> warnings_of(const Comparison& comparison);

} // namespace springproof::compare
