#pragma once

#include <string>

/// Results in files of their own, which a rerun of a command or `merge` takes up: a line with the format,
/// then a frame whose kind is the digest of all that the result depends on.
namespace springproof::compare {

/// Version, commit and digest of the running program. The commit does not tell one build of uncommitted
/// changes from another; the program's own bytes do.
const std::string& this_program();

/// Digest of a question's bytes, this program and PETSC_OPTIONS.
std::string identity_of(const std::string& question);

/// Whole or not at all.  @throws InputError if the file cannot be written
void write_kept(const std::string& path, const std::string& identity, const std::string& result);

/// @return the result in a file; empty if there is no file, or it is the result of another question
/// @throws std::runtime_error if it is of another format, or damaged
std::string read_kept(const std::string& path, const std::string& identity);

} // namespace springproof::compare
