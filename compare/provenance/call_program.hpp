#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Other programs (gnuplot, CalculiX, valgrind), and a place for their files. No shell takes part: a word is
/// an argument whatever it holds. A program is killed when this process ends, however that happens.
namespace springproof::compare {

struct ProgramCall {
  std::vector<std::string> words;     ///< the program, found on PATH, and its arguments
  std::string folder;                 ///< that it runs in
  std::vector<std::string> variables; ///< "NAME=VALUE", besides this process's environment
};

struct ProgramEnd {
  int status;       ///< exit status; 128 and the signal's number if one ended it
  std::string said; ///< on standard output and standard error
};

/// Runs it, without input, until it ends.
/// @return nothing if there is no such program
/// @throws std::system_error if it cannot be started for another reason
std::optional<ProgramEnd> call_program(const ProgramCall& call);

/// Pointers into the words, with a null at the end, as the system wants arguments and variables.
std::vector<char*> pointers_to(std::vector<std::string>& words);

/// A folder in the system's place for temporary files, removed with everything in it at the end of this
/// object's life, or of this process: a process of its own waits for that.
class ScratchFolder {
 public:
  /// @param purpose  part of its name
  /// @throws std::system_error if it cannot be made
  explicit ScratchFolder(const std::string& purpose);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int alive_ = -1;  ///< an end of a pipe, open as long as the folder is needed
  int remover_ = 0; ///< process id
};

} // namespace springproof::compare
