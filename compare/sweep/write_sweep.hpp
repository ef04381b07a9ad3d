#pragma once

#include "compare/sweep/sweep.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace springproof::compare {

/// A row per variant, the reference, what was left out, and the conclusions.
void write_sweep_text(std::ostream& out, const Sweep& sweep);

/// One row per variant; the header names the columns and their units, and fields without a value are empty.
void write_sweep_csv(std::ostream& out, const Sweep& sweep);

nlohmann::ordered_json sweep_to_json(const Sweep& sweep);

} // namespace springproof::compare
