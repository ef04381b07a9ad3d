#pragma once

#include "compare/sweep/sweep.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace springproof::compare {

/// A row per variant, the reference, what was left out, and the conclusions.
void write_sweep_text(std::ostream& out, const Sweep& sweep);

/// One row per variant; the header names the columns and their units, and fields without a value are empty.
void write_sweep_csv(std::ostream& out, const Sweep& sweep);

/// [{"what", "reason"}, ...]
nlohmann::ordered_json left_out_to_json(const std::vector<LeftOut>& left_out);

nlohmann::ordered_json sweep_to_json(const Sweep& sweep);

/// Error against time, log-log, as NAME.svg and NAME.png for both errors and both clocks, with the Pareto
/// front, the reference's uncertainty and the floor of each spring design. Nothing without a reference.
/// @throws InputError as draw()
void plot_sweep(const std::string& folder, const Sweep& sweep);

} // namespace springproof::compare
