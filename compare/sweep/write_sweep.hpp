#pragma once

#include "compare/sweep/sweep.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace springproof::compare {

/// What a sweep's numbers say, grouped: a heading and its sentences.
struct Conclusions {
  std::string heading;
  std::vector<std::string> sentences;
};
/// For both errors and both clocks: the fastest at 10, 5 and 1 per cent, the most accurate in 1, 16 and 100
/// ms; and for each error where more cells stop helping the springs.
std::vector<Conclusions> conclusions(const Sweep& sweep);

/// A row per variant, the reference, what was left out, and the conclusions.
void write_sweep_text(std::ostream& out, const Sweep& sweep);

/// One row per variant; the header names the columns and their units, and fields without a value are empty.
void write_sweep_csv(std::ostream& out, const Sweep& sweep);

nlohmann::ordered_json sweep_to_json(const Sweep& sweep);

/// Error against time, log-log, as NAME.svg and NAME.png for both errors and both clocks, with the Pareto
/// front, the reference's uncertainty and the floor of each spring design.
/// @return the names of the figures drawn; none without a reference
/// @throws InputError as draw()
std::vector<std::string> plot_sweep(const std::string& folder, const Sweep& sweep);

} // namespace springproof::compare
