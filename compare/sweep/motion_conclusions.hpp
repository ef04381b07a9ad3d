#pragma once

#include "compare/sweep/analysis.hpp"
#include "compare/sweep/motion_sweep.hpp"

/// What a sweep in time says. Motions that failed give no points.
namespace springproof::compare {

/// "springs hybrid, 8x2x2 cells, steps of 2 ms"; seconds are of computing for a second of motion. With
/// more_cells_percent where the method's finest mesh and shortest step leave a clearly larger error. Nothing
/// for a motion without an error.
std::optional<Point> point_of(const MotionSweep& sweep, const MotionRow& row);
std::vector<Point> points_of(const MotionSweep& sweep);

/// For pictures a second: the most accurate of the motions whose step is no longer than a picture and that
/// take no longer than the motion itself, and the most accurate of the other family. Where errors of mesh and
/// model cancel in the first, the most accurate in which they do not, too.
std::string interactive_sentence(const MotionSweep& sweep, double hertz);

/// At 30, 60 and 500 pictures a second.
std::vector<std::string> conclusions(const MotionSweep& sweep);

} // namespace springproof::compare
