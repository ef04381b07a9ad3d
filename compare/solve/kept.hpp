#pragma once

#include "compare/solve/solve.hpp"

/// What a command keeps in files for a rerun or for `merge`. Results: a line with the format, a line with the
/// identity of the question, the length and the digest of the result, and the result. Records of shards:
/// JSON.
namespace springproof::compare {

/// SHA-256 of these bytes as 64 hexadecimal digits.
std::string digest(const std::string& bytes);

/// Digest of what files hold. A file that is not there counts too.
std::string digest_of_files(const std::vector<std::string>& paths);

/// The content of a kept file.  @param identity  digest of all that the result depends on
std::string kept_text(const std::string& identity, const std::string& result);

/// @param text  content of a kept file
/// @return the result; empty if it is that of another question
/// @throws std::runtime_error if the text is of another format, or damaged
std::string result_in(const std::string& text, const std::string& identity);

/// An Answer or Answers on this mesh, from bytes that anybody may have made (cases::to_bytes() makes them).
/// @throws std::exception if they hold none: another length, an unknown enumerator, fields that are not of
/// the mesh, a converged solution without a finite displacement of every node and volume of every cell
template<class Result>
Result result_from(const std::string& bytes, const cases::Mesh& mesh);

struct Shard {
  int index = 1; ///< from 1 to count
  int count = 1;
};

/// "2/3"; nothing for anything else.
std::optional<Shard> shard_from(const std::string& text);

/// What a shard that has finished tells of itself, in DIR/shard.json.
struct ShardRecord {
  Shard shard;
  std::vector<std::string> command; ///< and its arguments that all shards have in common
  std::string questions;            ///< digest of all that the whole command's results depend on
  std::string program{};            ///< filled in by write_record()
};

std::string text_of(const ShardRecord& record);

/// @param text  any bytes
/// @throws std::exception if it is no record: a field is missing or of another type, there is no such shard
ShardRecord record_from(const std::string& text);

/// Names of the files in DIR/solved.
enum class FileNames {
  of_cases,    ///< for readers; one question a case
  of_questions ///< digests, where many questions are of one case
};

/// Version, commit and digest of the running program. The commit does not tell one build of uncommitted
/// changes from another; the bytes of the shared objects that hold the models do. They are read once, at the
/// first call.
const std::string& this_program();

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

  /// Keeps the answers to a question, and drops those on the single meshes of its study.
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

/// Digest of all that the answers to these questions depend on.
std::string digest_of(const std::vector<Question>& questions);

// The work of one command divided among several, on machines of their own: `--shard I/N` of each keeps what
// it has solved in its own folder, and `merge` puts the folders together.

/// Which shard has each piece of work: the largest first, each to the shard with the least to do so far.
/// @param costs  in any unit, one per piece
/// @return numbers from 1 to n_shards, one per piece; always the same
std::vector<int> divide(const std::vector<double>& costs, int n_shards);
/// Divides by estimated cost.
std::vector<int> divide(const std::vector<Question>& questions, int n_shards);

/// @throws InputError if it cannot be written
void write_record(const std::string& folder, ShardRecord record);
/// Removes the record of an earlier command, before its folder is used again.
void remove_record(const std::string& folder);

/// All shards of one command.
struct Shards {
  ShardRecord record;               ///< that of the first folder, whose number alone others do not have
  std::vector<std::string> folders; ///< by the shards' numbers
};

/// @throws InputError if a shard is missing or there twice, or is of another command, other questions,
/// another number of shards, or another program than the other shards and this one
Shards read_shards(const std::vector<std::string>& folders);

/// What the shards found, failed solves too.
/// @throws InputError if an answer is missing or damaged, or the questions are others
std::vector<Answers> answers_of(const Shards& shards, const std::vector<Question>& questions,
                                FileNames names);

} // namespace springproof::compare
