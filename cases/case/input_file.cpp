#include "cases/case/input_file.hpp"

#include "cases/case/error.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <memory>
#include <sys/stat.h>
#include <unistd.h>

namespace springproof::cases {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& problem) {
  throw InputError(path + ": " + problem);
}

bool begins_with(const std::string& text, const char* beginning) {
  return text.rfind(beginning, 0) == 0;
}

/// @throws InputError unless it may be read to its end  @return its size, which a pipe does not know
std::size_t size_of_readable(int file, const std::string& path) {
  struct stat status {};
  if (fstat(file, &status) != 0) refuse(path, std::string("cannot be read: ") + std::strerror(errno));
  if (S_ISREG(status.st_mode)) return static_cast<std::size_t>(status.st_size);
  if (S_ISDIR(status.st_mode)) refuse(path, std::string("cannot be read: ") + std::strerror(EISDIR));
  const bool is_of_shell = begins_with(path, "/dev/fd/") || path == "/dev/stdin";
  if (!S_ISFIFO(status.st_mode) || !is_of_shell) refuse(path, "cannot be read: is no regular file");
  fcntl(file, F_SETFL, 0); // wait for the writer
  return 0;
}

} // namespace

std::string read_bytes(const std::string& path, std::uint64_t largest) {
  // Opening waits for no writer of a pipe.
  const int file = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) refuse(path, std::string("cannot be read: ") + std::strerror(errno));
  const std::unique_ptr<const int, void (*)(const int*)> closed(&file, [](const int* open) { close(*open); });
  const std::size_t size = size_of_readable(file, path);
  const auto check = [&](std::size_t n) {
    if (n > largest) refuse(path, fmt::format("has {} bytes or more, may have {}", n, largest));
  };
  check(size);
  std::string bytes;
  for (std::size_t have = 0;;) {
    constexpr std::size_t piece = 1 << 16;
    bytes.resize(std::max(have + piece, have == 0 ? size + 1 : bytes.size()));
    const ssize_t n = read(file, bytes.data() + have, bytes.size() - have);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse(path, std::string("cannot be read: ") + std::strerror(errno));
    have += static_cast<std::size_t>(n);
    check(have);
    if (n > 0) continue;
    bytes.resize(have);
    return bytes;
  }
}

std::string read_text_file(const std::string& path, std::uint64_t largest) {
  std::string text = read_bytes(path, largest);
  if (begins_with(text, "\xef\xbb\xbf")) text.erase(0, 3);
  if (begins_with(text, "\xff\xfe") || begins_with(text, "\xfe\xff"))
    refuse(path, "is text in UTF-16, must be in UTF-8: save it so");
  if (text.find('\0') != std::string::npos) refuse(path, "has a byte of zero, must be text in UTF-8");
  return text;
}

} // namespace springproof::cases
