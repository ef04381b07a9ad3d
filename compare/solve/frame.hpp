#pragma once

#include <optional>
#include <string>

namespace springproof::compare {

/// SHA-256 of these bytes as 64 hexadecimal digits: it tells inputs apart, and finds damage to what was kept
/// or sent.
std::string digest(const std::string& bytes);

/// Bytes with their length and digest, as kept in files and sent between processes: a heading "KIND LENGTH
/// DIGEST" and a line break, then the content. The digest is of kind and content.
struct Frame {
  std::string kind; ///< one word
  std::string content;
};

std::string framed(const Frame& frame);

/// Takes a frame from the beginning of `bytes`; nothing as long as it is not complete.
/// @throws std::runtime_error if it is none, or damaged
std::optional<Frame> take_frame(std::string& bytes);

} // namespace springproof::compare
