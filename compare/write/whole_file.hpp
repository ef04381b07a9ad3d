#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace springproof::compare {

/// Writes a whole file or none: the content goes to a temporary name beside it, which is renamed over the
/// file when complete.
/// @throws InputError if the folder cannot be made or written
void write_file(const std::string& path, const std::function<void(std::ostream&)>& write);

/// Content of a file, byte by byte.
/// @throws InputError if it cannot be read
std::string read_file(const std::string& path);

} // namespace springproof::compare
