#pragma once

#include "compare/sweep/sweep.hpp"
#include "compare/table/json.hpp"

#include <ostream>

/// Sweeps as text, CSV, JSON and plots, and on one screen; those of motions too.
namespace springproof::compare {

/// A row per variant, the reference, what was left out, and the conclusions.
void write_sweep_text(std::ostream& out, const Sweep& sweep);

/// One row per variant; the header names the columns and their units, and fields without a value are empty.
void write_sweep_csv(std::ostream& out, const Sweep& sweep);

Json sweep_to_json(const Sweep& sweep);

/// Error against time, log-log, as NAME.svg and NAME.png for both errors and both clocks, with the Pareto
/// front, the reference's uncertainty and the floor of each spring design. Of motions one, of the error
/// against computing per second of motion: motion_sweep. Nothing without a reference.
/// @throws InputError as draw()
void plot_sweep(const std::string& folder, const Sweep& sweep);

/// What a sweep found, on one screen: the fastest of springs and finite elements at several errors, the most
/// accurate in real time, speed against error, and what was not solved. All rows are in the files.
/// @param folder  value of `--out`, where the files are; empty: none was given, and what to type is told
void write_sweep_screen(std::ostream& out, const Sweep& sweep, const std::string& folder);

} // namespace springproof::compare
