#pragma once

#include "compare/solve/answers.hpp"

/// What a command keeps in files for a rerun or for `merge`. Results: a line with the format, a line with the
/// identity of the question, the length and the digest of the result, and the result. Records of shards:
/// JSON.
namespace springproof::compare {

/// SHA-256 of these bytes as 64 hexadecimal digits.
std::string digest(const std::string& bytes);

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
Result result_from(const std::string& bytes, const cases::HexMesh& mesh);

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

} // namespace springproof::compare
