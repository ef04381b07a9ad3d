#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace springproof::compare {

/// Writes a whole file or none: the content goes to a temporary name, PATH.part, which is renamed over the
/// file when complete; one that a killed run has left is removed. A device, a pipe and what a link leads to
/// are written to as they are.
/// @throws InputError if it cannot be written, with the reason
void write_file(const std::string& path, const std::function<void(std::ostream&)>& write);

/// The same for whoever writes a file by its name, such as another program.
/// @param make  leaves the content under the name that it is given: the path with an ending of its own
/// @throws what `make` throws
void make_file(const std::string& path, const std::function<void(const std::string& temporary)>& make);

/// Content of a file, byte by byte.
/// @throws InputError if it cannot be read
std::string read_file(const std::string& path);

/// Makes the folder of `--out`, and keeps other processes from claiming it until this one ends: two would
/// overwrite each other's results. Rank 0 does so, before anything is solved.
/// @param folder  empty: none
/// @throws InputError if it cannot be made or written, or is claimed
void claim_folder(const std::string& folder);

} // namespace springproof::compare
