#pragma once

#include <memory>
#include <string>

/// A command's process, and its job's other ranks.
namespace springproof::compare {

/// Keeps the number of a closed standard stream from the next file that is opened: writing to it fails.
void reserve_standard_streams();

/// Ends a rank that meets an error. Rank 0 tells it. Returns when all ranks meet one; when some do not
/// within two seconds, ends them all with this status, because they may be waiting for this rank for ever.
void give_up(const std::string& message, int status);

/// Colours verdicts at the beginnings of lines of std::cout: met green, missed and failed red, warnings
/// yellow. Only on a terminal, unless NO_COLOR is set (no-color.org) or TERM is "dumb".
/// @return ends it when it is gone
std::shared_ptr<void> coloured_output();

} // namespace springproof::compare
