#include "compare/solve/shard.hpp"

#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/estimate.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>

namespace springproof::compare {

namespace {

std::string record_file(const std::string& folder) {
  return folder + "/shard.json";
}

ShardRecord read_record(const std::string& folder) {
  const std::string file = record_file(folder);
  if (!std::filesystem::exists(file))
    throw cases::InputError(folder +
                            ": has no shard.json: the shard has not finished, or this is no shard's folder");
  try {
    return record_from(read_file(file));
  } catch (const std::exception& error) {
    throw cases::InputError(file + ": is no shard's record: " + error.what());
  }
}

/// @throws InputError if two shards are not of one whole
void check_same(const std::string& folder, const ShardRecord& record, const std::string& other_folder,
                const ShardRecord& other) {
  const auto refuse = [&](const std::string& difference) {
    throw cases::InputError(
        fmt::format("{}: {}, and cannot be merged with {}", folder, difference, other_folder));
  };
  if (record.shard.count != other.shard.count)
    refuse(fmt::format("is one of {} shards, not {}", record.shard.count, other.shard.count));
  if (record.program != other.program) refuse("was made by another program");
  if (record.command != other.command)
    refuse(fmt::format("is of another command (springproof {})", fmt::join(record.command, " ")));
  if (record.questions != other.questions) refuse("is of other cases or settings");
}

} // namespace

std::vector<int> divide(const std::vector<double>& costs, int n_shards) {
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
  std::vector<double> load(static_cast<std::size_t>(n_shards));
  std::vector<int> shard_of(costs.size());
  for (const std::size_t piece : order) {
    const auto least = std::min_element(load.begin(), load.end());
    *least += costs[piece];
    shard_of[piece] = static_cast<int>(least - load.begin()) + 1;
  }
  return shard_of;
}

std::vector<int> divide(const std::vector<Question>& questions, int n_shards) {
  std::vector<double> costs;
  for (const Question& question : questions) costs.push_back(total_seconds(estimate(question)));
  return divide(costs, n_shards);
}

void write_record(const std::string& folder, ShardRecord record) {
  record.program = this_program();
  write_file(record_file(folder), [&](std::ostream& out) { out << text_of(record); });
}

void remove_record(const std::string& folder) {
  std::error_code absent;
  std::filesystem::remove(record_file(folder), absent);
}

Shards read_shards(const std::vector<std::string>& folders) {
  const std::string& first_folder = folders.at(0);
  const ShardRecord first = read_record(first_folder);
  if (first.program != this_program())
    throw cases::InputError(fmt::format("{}: was made by another program ({}) than this one ({})",
                                        first_folder, first.program, this_program()));
  Shards shards{std::vector<ShardRecord>(static_cast<std::size_t>(first.shard.count)),
                std::vector<std::string>(static_cast<std::size_t>(first.shard.count))};
  for (const std::string& folder : folders) {
    ShardRecord record = read_record(folder);
    check_same(folder, record, first_folder, first);
    const auto place = static_cast<std::size_t>(record.shard.index - 1);
    if (!shards.folders[place].empty())
      throw cases::InputError(fmt::format("{}: is shard {} of {}, and so is {}", folder, record.shard.index,
                                          record.shard.count, shards.folders[place]));
    shards.records[place] = std::move(record);
    shards.folders[place] = folder;
  }
  std::vector<std::size_t> missing;
  for (std::size_t s = 0; s < shards.folders.size(); ++s)
    if (shards.folders[s].empty()) missing.push_back(s + 1);
  if (!missing.empty())
    throw cases::InputError(fmt::format("merge: of {} shards {} {} missing", first.shard.count,
                                        fmt::join(missing, ", "), missing.size() == 1 ? "is" : "are"));
  return shards;
}

void check_questions(const Shards& shards, const std::string& digest) {
  if (digest != shards.records.front().questions)
    throw cases::InputError("merge: the cases are not what they were when the shards solved them");
}

std::vector<Answers> answers_of(const Shards& shards, const std::vector<Question>& questions,
                                FileNames names) {
  check_questions(shards, digest_of(questions));
  const std::vector<int> shard_of = divide(questions, static_cast<int>(shards.folders.size()));
  std::vector<Answers> answers;
  for (std::size_t q = 0; q < questions.size(); ++q)
    answers.push_back(
        kept_answers(shards.folders[static_cast<std::size_t>(shard_of[q] - 1)], questions[q], names));
  return answers;
}

} // namespace springproof::compare
