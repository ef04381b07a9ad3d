#pragma once

#include "compare/provenance/call_program.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace springproof::compare {

/// What a confined program may use.
struct ProgramLimits {
  double seconds = 600;                  ///< from its start to its end
  std::uint64_t memory = 4'000'000'000;  ///< bytes of data a process
  std::uint64_t file_size = 100'000'000; ///< bytes a file
};

/// A stranger's program that talks through its standard input and output. The kernel lets it read files and
/// write into one folder, its own; it has no network and no sockets, and all that it starts ends with it
/// (namespaces of users, mounts, processes and networks; seccomp). No shell takes part.
class ConfinedProgram {
 public:
  /// @param words  the program, found on PATH or by a path, and its arguments
  /// @throws cases::SolveError if it cannot be started, or this system cannot confine it
  ConfinedProgram(std::vector<std::string> words, const ProgramLimits& limits);
  ~ConfinedProgram(); ///< ends it, and what it has started
  ConfinedProgram(const ConfinedProgram&) = delete;
  ConfinedProgram& operator=(const ConfinedProgram&) = delete;

  /// Writes bytes. A line that the program says before it has taken them is an error.
  /// @param seconds  within which it must take them    @param stage  for messages: "reading the scene"
  /// @throws cases::SolveError if it does not, or has ended
  void write(const std::string& bytes, double seconds, const std::string& stage);

  /// Reads up to the next end of line, without it.
  /// @param most_bytes  a longer line is an error
  /// @throws cases::SolveError, likewise
  std::string read_line(std::size_t most_bytes, double seconds, const std::string& stage);
  /// Reads so many bytes.
  std::string read_bytes(std::size_t n, double seconds, const std::string& stage);

 private:
  struct Wait; ///< until when, and for what
  void fill(const Wait& wait, std::size_t most);
  [[noreturn]] void fail(const std::string& stage, const std::string& what);
  [[noreturn]] void fail_ended(const std::string& stage);
  std::string last_words() const;

  ProgramLimits limits_;
  ScratchFolder folder_{"client"};
  std::string name_;
  std::string said_; ///< read, and not yet taken
  double end_ = 0;   ///< when all of its time is over, s
  int process_ = 0, in_ = -1, out_ = -1;
};

/// Words of a command line as a shell parts them: by blanks, but for those between ' or ". Nothing else has
/// a meaning.
/// @throws cases::InputError if a quote is not closed, or there is no word
std::vector<std::string> words_of_command(const std::string& command);

} // namespace springproof::compare
