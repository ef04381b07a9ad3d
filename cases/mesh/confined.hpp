#pragma once

#include <functional>
#include <string>

namespace springproof::cases {

/// Runs a function in a child process that can compute, read files and answer, and nothing else: the kernel
/// (seccomp) refuses to start programs, to open, create, rename or remove files for writing, and to use the
/// network. For libraries that interpret a stranger's file as a program, or crash on a broken one.
/// @param work     returns the answer; what it prints is discarded
/// @param seconds  limit of processor and wall-clock time, > 0
/// @return the answer, any bytes
/// @throws std::runtime_error with the message of the exception that work threw; with the reason when the
/// child crashed, exited by itself, exceeded the time, or could not be confined
std::string run_confined(const std::function<std::string()>& work, int seconds);

} // namespace springproof::cases
