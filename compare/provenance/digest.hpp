#pragma once

#include <string>

namespace springproof::compare {

/// SHA-256 of these bytes as 64 hexadecimal digits: it tells inputs apart, and finds damage to what was kept
/// or sent.
std::string digest(const std::string& bytes);

} // namespace springproof::compare
