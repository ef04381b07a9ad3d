#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace springproof::compare {

/// Ending of a file that is not complete yet.
inline const std::string unfinished = ".springproof-part";

/// Writes a whole file or none: the content goes to a temporary name, with the ending of what is unfinished,
/// which is renamed over the file when complete. A file that was there passes on its mode and owner; anything
/// else, such as a link, is replaced: whoever made it does not say what is written to.
/// @throws InputError if it cannot be written, with the reason
void write_file(const std::string& path, const std::function<void(std::ostream&)>& write);

/// The same for whoever writes a file by its name, such as another program.
/// @param make  leaves the content under the name that it is given: the path with an ending of its own
/// @throws what `make` throws
void make_file(const std::string& path, const std::function<void(const std::string& temporary)>& make);

/// The same for a path of the command line, where a device, a pipe and what a link leads to are written to as
/// they are.
void write_named_file(const std::string& path, const std::function<void(std::ostream&)>& write);

/// Checks that a file can be written, before the work whose results go there.
/// @param path  as for write_named_file(); empty: none
/// @throws InputError if it cannot be written
void check_named_file(const std::string& path);

/// Content of a file, byte by byte.
/// @throws InputError if it cannot be read
std::string read_file(const std::string& path);

/// Makes the folder of `--out`, and keeps other processes from claiming it until this one ends: two would
/// overwrite each other's results. What killed ones have left unfinished is removed. Rank 0 does so, before
/// anything is solved.
/// @param folder  empty: none
/// @throws InputError if it cannot be made, or written to, or is claimed, or a folder stands where a file of
/// results may be written
void claim_folder(const std::string& folder);

/// The same for a folder in it, which must be no link.
void claim_subfolder(const std::string& folder, const std::string& name);

} // namespace springproof::compare
