#include "cases/mesh/deflated.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <new>
#include <stdexcept>
#include <zlib.h>

namespace springproof::cases {

namespace {

constexpr std::size_t piece = 1 << 16; ///< bytes at once

/// zlib's decompressor of either format.
class Inflater {
 public:
  Inflater() {
    constexpr int largest_window = 15, of_either_format = 32;
    if (inflateInit2(&stream_, largest_window + of_either_format) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  bool is_at_end() const { return is_at_end_; } ///< of a stream, its checksum right

  /// @throws std::runtime_error if the bytes go on as no stream does  @return how many bytes they hold
  std::uint64_t take(std::string& bytes) {
    stream_.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream_.avail_in = static_cast<uInt>(bytes.size());
    std::uint64_t held = 0;
    do {
      if (is_at_end_ && !begins_another()) return held;
      stream_.next_out = out_.data();
      stream_.avail_out = static_cast<uInt>(out_.size());
      const int status = inflate(&stream_, Z_NO_FLUSH);
      if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
        throw std::runtime_error(std::string("is damaged where it is compressed: ") +
                                 (stream_.msg == nullptr ? "zlib fails" : stream_.msg));
      held += out_.size() - stream_.avail_out;
      is_at_end_ = status == Z_STREAM_END;
    } while (stream_.avail_in > 0 || stream_.avail_out == 0);
    return held;
  }

 private:
  z_stream stream_{};
  std::array<Bytef, piece> out_{};
  bool is_at_end_ = false, is_over_ = false;

  /// gzip's files may be one after the other; what else comes after the end belongs to nobody.
  bool begins_another() {
    constexpr Bytef first_of_gzip = 0x1f;
    is_over_ = is_over_ || (stream_.avail_in > 0 && *stream_.next_in != first_of_gzip);
    if (is_over_ || stream_.avail_in == 0) return false;
    inflateReset(&stream_);
    is_at_end_ = false;
    return true;
  }
};

} // namespace

void check_deflated(const Deflated& deflated, std::uint64_t least, std::uint64_t most) {
  std::ifstream stream(deflated.file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(deflated.from));
  Inflater inflater;
  std::uint64_t held = 0;
  std::string bytes;
  for (std::uint64_t left = deflated.bytes; left > 0;) {
    bytes.resize(static_cast<std::size_t>(std::min<std::uint64_t>(left, piece)));
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) break;
    left -= bytes.size();
    held += inflater.take(bytes);
    if (held > most)
      throw std::runtime_error("holds more than " + std::to_string(most) +
                               " bytes where it is compressed, far more than its header says");
  }
  if (!inflater.is_at_end()) throw std::runtime_error("is cut short: what is compressed has no end");
  if (held < least)
    throw std::runtime_error("is cut short: holds " + std::to_string(held) +
                             " bytes where it is compressed, its header says " + std::to_string(least));
}

} // namespace springproof::cases
