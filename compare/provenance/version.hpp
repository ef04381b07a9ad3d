#pragma once

#include <string>

namespace springproof::compare {

std::string program_version();
std::string
program_commit(); ///< short hash, with "-dirty" for uncommitted changes; "unknown" outside a checkout

} // namespace springproof::compare
