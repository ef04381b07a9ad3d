#pragma once

#include <cstdint>
#include <string>

/// Opens all files of strangers that are read here and not by a library.
namespace springproof::cases {

inline constexpr std::uint64_t largest_case = 64'000'000, largest_text = 2'000'000'000,
                               largest_file = 64'000'000'000; ///< bytes

/// All bytes of a regular file. A pipe is read where the command line's shell has made it (/dev/fd/...,
/// /dev/stdin): any other pipe or device may never end.
/// @throws InputError "PATH: ...", also for more bytes than `largest`
std::string read_bytes(const std::string& path, std::uint64_t largest = largest_file);

/// A text in UTF-8, without the mark of its order of bytes that some programs put first.
/// @throws InputError as read_bytes(), and for UTF-16 and other bytes that no text has
std::string read_text_file(const std::string& path, std::uint64_t largest = largest_text);

} // namespace springproof::cases
