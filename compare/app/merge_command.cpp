#include "cases/case/error.hpp"
#include "compare/app/commands.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/shard.hpp"

#include <algorithm>

namespace springproof::compare {

namespace {

constexpr const char* recorded_options[] = {"--set=",         "--converge=", "--msm-displacements=",
                                            "--interpolate=", "--replay=",   "--trace="};

struct MergeOptions {
  std::vector<std::string> folders;
  std::string out, junit;
  bool json = false, annotate = false;
};

/// A record is a file that anybody may have made: nothing in it may name what is written.
/// @throws InputError for an argument that no shard records
void check_arguments(const std::vector<std::string>& command) {
  for (std::size_t w = 1; w < command.size(); ++w) {
    const std::string& word = command[w];
    const auto is_it = [&](const char* option) { return word.rfind(option, 0) == 0; };
    if (is_it("-") && std::none_of(std::begin(recorded_options), std::end(recorded_options), is_it))
      throw cases::InputError("merge: a shard's record has the argument \"" + word +
                              "\", which no shard writes there");
  }
}

/// The shards' command with their results in place of solving, and with outputs of its own.
int merge(const MergeOptions& options) {
  if (mpi_rank() != 0) return 0;
  std::vector<std::string> words = read_shards(options.folders).records.front().command;
  check_arguments(words);
  for (const std::string& folder : options.folders) words.push_back("--merged=" + folder);
  if (!options.out.empty()) words.push_back("--out=" + options.out);
  if (!options.junit.empty()) words.push_back("--junit=" + options.junit);
  if (options.json) words.emplace_back("--json");
  if (options.annotate) words.emplace_back("--annotate");
  CLI::App commands;
  Action chosen;
  for (const auto add : {add_gate_command, add_tables_command}) add(commands, chosen);
  commands.require_subcommand(1);
  std::reverse(words.begin(), words.end()); // as CLI11 takes them
  try {
    commands.parse(words);
  } catch (const CLI::ParseError& error) {
    throw cases::InputError(std::string("merge: ") + error.what());
  }
  return chosen();
}

} // namespace

void add_merge_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<MergeOptions>(
      program, chosen, "merge", "one report and one exit status of the shards of gate or tables",
      merge);
  command->add_option("folder", options->folders, "of each shard's --out")->required();
  command->add_option("--out", options->out, "folder for the files of the whole command's --out");
  command->add_option("--junit", options->junit, "of gate: file for the verdicts as JUnit's XML");
  command->add_flag("--annotate", options->annotate, "of gate: GitHub's annotations too");
  add_json_option(*command, options->json);
}

} // namespace springproof::compare
