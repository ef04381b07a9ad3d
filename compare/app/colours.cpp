#include "compare/app/colours.hpp"

#include "compare/solve/process_pool.hpp"

#include <algorithm>
#include <cstdlib>
#include <ostream>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace springproof::compare {

namespace {

using namespace std::string_view_literals;

constexpr std::pair<std::string_view, std::string_view> colour_of_word[] = {
    {"met "sv, "32"sv},       {"all gates met"sv, "32"sv}, {"MISSED"sv, "31"sv},
    {"not judged"sv, "33"sv}, {"FAILED"sv, "31"sv},        {"GATES FAILED"sv, "31"sv},
    {"DIFFERS"sv, "31"sv},    {"warning:"sv, "33"sv},      {"Warning:"sv, "33"sv}};

/// Holds a line back until it is whole, or flushed.
class Colouring : public std::streambuf {
 public:
  explicit Colouring(std::streambuf& plain) : plain_(plain) {}
  ~Colouring() override { sync(); }

 private:
  int overflow(int character) override {
    if (character == traits_type::eof()) return 0;
    line_ += static_cast<char>(character);
    return character == '\n' && !write() ? traits_type::eof() : character;
  }
  int sync() override { return write() ? plain_.pubsync() : -1; }

  bool write() {
    const std::size_t begin = std::min(line_.find_first_not_of(' '), line_.size());
    for (const auto& [word, colour] : colour_of_word)
      if (line_.compare(begin, word.size(), word) == 0) {
        const std::size_t end = word.find_last_not_of(' ') + 1;
        line_.insert(begin + end, "\033[0m");
        line_.insert(begin, "\033[" + std::string(colour) + "m");
        break;
      }
    const auto n = static_cast<std::streamsize>(line_.size());
    const bool is_written = plain_.sputn(line_.data(), n) == n;
    line_.clear();
    return is_written;
  }

  std::streambuf& plain_;
  std::string line_;
};

bool wants_colours(int descriptor) {
  const char* const none = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  // MPI's launcher gives each rank a terminal, whatever its own output is.
  return isatty(descriptor) == 1 && !is_under_mpi_launcher() && !(none && *none) &&
         !(terminal && terminal == "dumb"sv);
}

} // namespace

Colours::Colours(std::ostream& stream, int descriptor) : stream_(stream), plain_(stream.rdbuf()) {
  if (!wants_colours(descriptor)) return;
  colouring_ = std::make_unique<Colouring>(*plain_);
  stream_.rdbuf(colouring_.get());
}

Colours::~Colours() {
  if (colouring_) stream_.rdbuf(plain_);
}

} // namespace springproof::compare
