#pragma once

#include <optional>
#include <string>
#include <vector>

/// What is known of a shard without its folder.
namespace springproof::compare {

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
