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

constexpr const char* blanks = " \t\r\v\f";

std::vector<std::string_view> fields_of(std::string_view line, Between between) {
  std::vector<std::string_view> fields;
  const bool by_blanks = between == Between::commas_or_blanks && line.find(',') == line.npos;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end =
        std::min(by_blanks ? line.find_first_of(blanks, begin) : line.find(',', begin), line.size());
    fields.push_back(without_blanks(line.substr(begin, end - begin)));
    begin = end + 1;
    if (by_blanks) begin = std::max(begin, std::min(line.find_first_not_of(blanks, begin), line.size()));
  }
  return fields;
}

bool is_heading(const TextRow& row) {
  return std::isalpha(static_cast<unsigned char>(row.line.front())) != 0 &&
         std::none_of(row.fields.begin(), row.fields.end(),
                      [](std::string_view field) { return number_in<double>(field); });
}

} // namespace

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

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

bool read_rows(const std::string& text, const std::string& name, Between between,
               const std::function<void(const TextRow&)>& heading,
               const std::function<void(const TextRow&)>& row) {
  bool is_first = true, has_heading = false;
  const std::string_view all = text;
  int number = 0;
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('\n', begin), all.size());
    const std::string_view line = without_blanks(all.substr(begin, end - begin));
    begin = end + 1;
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const TextRow read{fields_of(line, between), line, name, number};
    if (is_first && is_heading(read)) {
      has_heading = true;
      heading(read);
    } else {
      row(read);
    }
    is_first = false;
  }
  return has_heading;
}

} // namespace springproof::cases
