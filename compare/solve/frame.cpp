#include "compare/solve/frame.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <openssl/sha.h>
#include <sstream>

namespace springproof::compare {

std::string digest(const std::string& bytes) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> sum;
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), sum.data());
  return fmt::format("{:02x}", fmt::join(sum, ""));
}

std::string framed(const Frame& frame) {
  return fmt::format("{} {} {}\n", frame.kind, frame.content.size(),
                     digest(frame.kind + ' ' + frame.content)) +
         frame.content;
}

std::optional<Frame> take_frame(std::string& bytes) {
  constexpr std::size_t longest_heading = 200;
  const std::size_t begin = bytes.find('\n') + 1;
  if (begin == 0 && bytes.size() < longest_heading) return std::nullopt;
  std::istringstream heading(bytes.substr(0, std::min(begin, longest_heading)));
  Frame frame;
  std::size_t size = 0;
  std::string expected;
  if (!(heading >> frame.kind >> size >> expected)) throw std::runtime_error("is no frame");
  if (bytes.size() - begin < size) return std::nullopt;
  frame.content = bytes.substr(begin, size);
  if (digest(frame.kind + ' ' + frame.content) != expected) throw std::runtime_error("is damaged");
  bytes.erase(0, begin + size);
  return frame;
}

} // namespace springproof::compare
