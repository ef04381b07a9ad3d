#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace springproof::cases {

/// What a confined process may use.
struct Limits {
  int seconds;         ///< processor and wall-clock time, > 0
  std::uint64_t bytes; ///< memory, besides what this process has
};

/// Limits that let a file of so many bytes be read, far below what a file can claim to contain.
Limits limits_to_read(std::uint64_t file_size);

/// For gmsh to mesh a geometry, however short its text.
inline constexpr Limits limits_to_mesh{600, 8'000'000'000};

/// Lowers a resource limit of this process (RLIMIT_...); the user's own may be lower still.
void lower_limit(int resource, std::uint64_t most);

/// Runs a function in a child process that can compute, read files and answer, and nothing else: the kernel
/// (seccomp) refuses to start programs, to open, create, rename or remove files for writing, and to use the
/// network. For libraries that interpret a stranger's file as a program, or crash on a broken one.
/// @param work  returns the answer; what it prints is discarded
/// @return the answer, any bytes
/// @throws std::runtime_error with the message of the exception that work threw; with the reason when the
/// child crashed, exited by itself, exceeded a limit, or could not be confined
std::string run_confined(const std::function<std::string()>& work, const Limits& limits);

} // namespace springproof::cases
