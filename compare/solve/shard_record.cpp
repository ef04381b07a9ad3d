#include "compare/solve/shard_record.hpp"

#include "cases/case/rows.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace springproof::compare {

namespace {

constexpr int most_shards = 10'000;

bool exists(const Shard& shard) {
  return 1 <= shard.index && shard.index <= shard.count && shard.count <= most_shards;
}

/// 0, which no shard has, for anything else than a number that one may have.
int shard_number(const nlohmann::json& value) {
  const std::int64_t number = value.is_number_integer() ? value.get<std::int64_t>() : 0;
  return 1 <= number && number <= most_shards ? static_cast<int>(number) : 0;
}

} // namespace

std::optional<Shard> shard_from(const std::string& text) {
  const std::size_t stroke = std::min(text.find('/'), text.size());
  const std::string_view all = text;
  const auto index = cases::number_in<int>(all.substr(0, stroke)),
             count = cases::number_in<int>(all.substr(std::min(stroke + 1, all.size())));
  if (!index || !count) return std::nullopt;
  const Shard shard{*index, *count};
  return exists(shard) ? std::optional(shard) : std::nullopt;
}

std::string text_of(const ShardRecord& record) {
  const nlohmann::ordered_json json{{"shard", record.shard.index},
                                    {"of", record.shard.count},
                                    {"command", record.command},
                                    {"questions", record.questions},
                                    {"program", record.program}};
  return json.dump(2) + '\n';
}

ShardRecord record_from(const std::string& text) {
  const auto json = nlohmann::json::parse(text);
  ShardRecord record;
  record.shard = {shard_number(json.at("shard")), shard_number(json.at("of"))};
  json.at("command").get_to(record.command);
  json.at("questions").get_to(record.questions);
  json.at("program").get_to(record.program);
  if (!exists(record.shard))
    throw std::runtime_error(
        fmt::format("there is no shard {} of {}", record.shard.index, record.shard.count));
  return record;
}

} // namespace springproof::compare
