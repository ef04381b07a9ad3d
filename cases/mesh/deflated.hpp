#pragma once

#include <cstdint>
#include <string>

namespace springproof::cases {

/// Where a file has bytes that are compressed as zlib or gzip does it.
struct Deflated {
  std::string file;
  std::uint64_t from = 0, bytes = 0;
};

/// Inflates them piece by piece, and keeps none: readers believe bytes that a checksum refutes, and what has
/// no end.
/// @param least, most  how many bytes they may hold
/// @throws std::runtime_error unless they are whole, their checksums right, and as many
void check_deflated(const Deflated& deflated, std::uint64_t least, std::uint64_t most);

} // namespace springproof::cases
