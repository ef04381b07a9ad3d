#pragma once

#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// The cases that an earlier, interrupted command has solved, kept in DIR/solved, one file a case. One is
/// taken up again only if all that its answers depend on is the same: this program, the case as it was parsed
/// with the mesh that its files gave, the request and PETSC_OPTIONS. A file that is damaged or of another
/// version counts as none, with a line on standard error. Failed solves are not kept.
class FinishedCases {
 public:
  /// Claims the folder. Every rank calls it.
  /// @param folder  of `--out`; empty: nothing is kept, nothing found
  /// @throws InputError if the folder cannot be written, or two cases have one name and so one file
  FinishedCases(const std::string& folder, const std::vector<Question>& questions);

  /// The answers of an earlier command, with a line that says so. Collective over MPI_COMM_WORLD: rank 0
  /// reads, all get them.
  std::optional<Answers> find(const Question& question) const;

  /// @throws InputError if the file cannot be written
  void keep(const Question& question, const Answers& answers) const;

 private:
  std::string path_of(const Question& question) const;
  std::string folder_;
};

} // namespace springproof::compare
