#pragma once

#include "compare/solve/finished.hpp"
#include "compare/solve/kept.hpp"

/// The work of one command divided among several, on machines of their own: `--shard I/N` of each keeps what
/// it has solved in its own folder, and `merge` puts the folders together.
namespace springproof::compare {

/// Which shard has each piece of work: the largest first, each to the shard with the least to do so far.
/// @param costs  in any unit, one per piece
/// @return numbers from 1 to n_shards, one per piece; always the same
std::vector<int> divide(const std::vector<double>& costs, int n_shards);
/// Divides by estimated cost.
std::vector<int> divide(const std::vector<Question>& questions, int n_shards);

/// @throws InputError if it cannot be written
void write_record(const std::string& folder, ShardRecord record);
/// That of an earlier command, before its folder is used again.
void remove_record(const std::string& folder);

/// All shards of one command.
struct Shards {
  std::vector<ShardRecord> records; ///< by number
  std::vector<std::string> folders; ///< folders, likewise
};

/// @throws InputError if a shard is missing or there twice, or is of another command, other questions,
/// another number of shards, or another program than the other shards and this one
Shards read_shards(const std::vector<std::string>& folders);

/// @throws InputError if the merged command needs other results than the shards were asked for
void check_questions(const Shards& shards, const std::string& digest);

/// What the shards found, failed solves too.
/// @throws InputError if an answer is missing or damaged, or the questions are others
std::vector<Answers> answers_of(const Shards& shards, const std::vector<Question>& questions,
                                FileNames names);

} // namespace springproof::compare
