#include "compare/app/commands.hpp"

#include "compare/provenance/machine.hpp"
#include "compare/solve/process_pool.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <iostream>
#include <mpi.h>
#include <streambuf>
#include <string_view>
#include <thread>
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

bool wants_colours() {
  const char* const none = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  // MPI's launcher gives each rank a terminal, whatever its own output is.
  return isatty(STDOUT_FILENO) == 1 && !is_under_mpi_launcher() && !(none && *none) &&
         !(terminal && terminal == "dumb"sv);
}

} // namespace

void reserve_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1) open("/dev/null", O_RDONLY);
  std::signal(SIGXFSZ, SIG_IGN); // writing beyond a limit (ulimit -f) fails with a reason
}

void give_up(const std::string& message, int status) {
  const int rank = mpi_rank();
  if (rank == 0) std::cerr << message << std::endl;
  if (n_mpi_ranks() == 1) return;
  MPI_Request everyone;
  MPI_Ibarrier(MPI_COMM_WORLD, &everyone);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  int all_are_here = 0;
  while (MPI_Test(&everyone, &all_are_here, MPI_STATUS_IGNORE) == MPI_SUCCESS && !all_are_here) {
    if (std::chrono::steady_clock::now() > end) {
      if (rank != 0) std::cerr << "rank " << rank << ": " << message << std::endl;
      MPI_Abort(MPI_COMM_WORLD, status);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::shared_ptr<void> coloured_output() {
  if (!wants_colours()) return nullptr;
  std::streambuf* const plain = std::cout.rdbuf();
  const auto colouring = std::make_shared<Colouring>(*plain);
  std::cout.rdbuf(colouring.get());
  return {colouring.get(), [colouring, plain](void*) { std::cout.rdbuf(plain); }};
}

} // namespace springproof::compare
