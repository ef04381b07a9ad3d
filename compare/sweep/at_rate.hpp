#pragma once

#include "compare/sweep/halving.hpp"
#include "compare/table/table.hpp"

/// What to use at a rate: springs of several designs and cells, stepped by the methods of [msm] real_time
/// with several substeps and iterations, by their errors and the time of a frame: `springproof sweep --at`.
namespace springproof::compare {

/// Longest time of a frame, in frames, of a configuration that is followed: the next best may miss the rate.
constexpr double most_frames = 1.5;

/// Searches by halving. Bodies come to rest, those with [dynamics] move in steps of a frame. Designs whose
/// springs are among the worst three quarters in equilibrium on a level are left out at rest; what does not
/// come to rest, or is given up, is a row with its reason. One after the other in this process, on one
/// thread.
/// @param on_row  called with the sweep as it is after every row
/// @throws InputError where the case has no density, or no springs that can be stepped; SolveError when the
/// reference of a motion fails
Sweep sweep_at_rate(cases::Case definition, const Rate& rate, Extent extent,
                    const std::function<void(const Sweep&)>& on_row);

/// Times of a row of the front, each the median of up to n_timed_frames.
constexpr int n_timings = 3, n_timed_frames = 60;

/// Says what to use on this machine at the rate, the most accurate that keeps it, and what the next best errs
/// by and costs: the next more accurate of the front, which misses the rate, otherwise the next faster.
std::string rate_sentence(const Sweep& sweep);

// Parts of the writers of write_sweep.hpp

Json rate_row_to_json(const Sweep& sweep, const SweepRow& row);
/// The same with the cells as a text.
Json row_of_text(const Sweep& sweep, const SweepRow& row);
/// The columns of these rows in CSV, and in text.
Columns rate_columns(const cases::Case& definition);
Columns rate_columns_of_text(const cases::Case& definition);
/// The reference, the sentence and the front.
void write_rate_screen(std::ostream& out, const Sweep& sweep);

} // namespace springproof::compare
