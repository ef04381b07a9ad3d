#pragma once

#include "compare/solve/solve.hpp"

namespace springproof::compare {

/// Names of the files in DIR/solved.
enum class FileNames {
  of_cases,    ///< for readers; one question a case
  of_questions ///< digests, where many questions are of one case
};

/// Version, commit and digest of the running program. The commit does not tell one build of uncommitted
/// changes from another; the program's own bytes do.
const std::string& this_program();

/// Digest of a question's bytes, this program and PETSC_OPTIONS.
std::string identity_of(const std::string& question);

/// Whole or not at all.  @throws InputError if the file cannot be written
void write_kept(const std::string& path, const std::string& identity, const std::string& result);

/// @return the result in a file; empty if there is no file, or it is the result of another question
/// @throws std::runtime_error if it is of another format, or damaged
std::string read_kept(const std::string& path, const std::string& identity);

/// The cases that an earlier, interrupted command has solved, kept in DIR/solved, one file a question, which
/// rank 0 reads and writes. One is taken up again only if all that its answers depend on is the same: this
/// program, the case as it was parsed with the mesh that its files gave, the request and PETSC_OPTIONS. A
/// file that is damaged or of another version counts as none, with a line on standard error. Failed solves
/// are kept for `merge`, and tried again by a rerun.
class FinishedCases {
 public:
  /// Claims the folder. Every rank calls it.
  /// @param folder  value of `--out`; empty: nothing is kept, nothing found
  /// @throws InputError if the folder cannot be written, or two cases have one name and so one file
  FinishedCases(const std::string& folder, const std::vector<Question>& questions,
                FileNames names = FileNames::of_cases);

  /// The answers of an earlier command, with a line that says so. Collective over MPI_COMM_WORLD, as keep().
  std::optional<Answers> find(const Question& question) const;

  /// Single meshes of the case's mesh study are no longer needed then.
  /// @throws InputError if the file cannot be written
  void keep(const Question& question, const Answers& answers) const;

  /// The finite elements' answers on single meshes of a question's study, for when it is interrupted: kept
  /// one file a mesh, as soon as it is solved. May be used by a worker process.
  /// @param folder  that a FinishedCases has claimed; empty: nothing is kept
  static KeptMeshes meshes_in(const std::string& folder, const Question& question);
  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
  FileNames names_;
};

/// What FinishedCases::keep() has left in a folder, failed solves too.
/// @throws InputError if there is nothing for this question, or it is damaged
Answers kept_answers(const std::string& folder, const Question& question, FileNames names);

/// Digest of all that the answers to these questions depend on.
std::string digest_of(const std::vector<Question>& questions);

} // namespace springproof::compare
