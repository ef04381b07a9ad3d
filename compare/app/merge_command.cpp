#include "cases/case/error.hpp"
#include "compare/app/commands.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>

namespace springproof::compare {

namespace {

constexpr const char* recorded_options[] = {
    "--set=", "--converge=", "--msm-displacements=", "--interpolate=", "--array=", "--replay=", "--trace="};

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
  std::vector<std::string> words = read_shards(options.folders).record.command;
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

/// The command's name and arguments as they were given, without the options in the list.
std::vector<std::string> command_line(const CLI::App& command,
                                      const std::vector<const CLI::Option*>& without) {
  std::vector<std::string> words{command.get_name()};
  for (const CLI::Option* option : command.get_options()) {
    if (std::find(without.begin(), without.end(), option) != without.end()) continue;
    const std::string prefix = option->nonpositional() ? option->get_name() + "=" : "";
    for (const std::string& value : option->results()) words.push_back(prefix + value);
  }
  return words;
}

} // namespace

CLI::Option* add_shard_options(CLI::App& command, ShardOptions& options, CLI::Option* out,
                               const std::vector<CLI::Option*>& not_divided) {
  CLI::Option* part =
      command
          .add_option("--shard", options.part,
                      "I/N: solve part I of N alone, into --out; `springproof merge` puts the parts together")
          ->needs(out)
          ->check([](const std::string& text) {
            return shard_from(text) ? "" : "must be I/N with I from 1 to N, such as 2/4, but is " + text;
          });
  CLI::Option* merged = command.add_option("--merged", options.folders)->group("")->excludes(part);
  for (CLI::Option* option : not_divided) part->excludes(option);
  command.parse_complete_callback([&command, &options, part, merged, out] {
    options.command = command_line(command, {part, merged, out, command.get_option_no_throw("--workers")});
  });
  return merged;
}

int solve_shard(const ShardOptions& options, const std::vector<Question>& all, FileNames names,
                const std::string& out, const SolveOptions& solve_options) {
  const Shard shard = shard_from(options.part).value();
  const FinishedCases finished(out, all, names);
  if (mpi_rank() == 0) remove_record(out);
  const std::vector<int> shard_of = divide(all, shard.count);
  std::vector<Question> part;
  for (std::size_t q = 0; q < all.size(); ++q)
    if (shard_of[q] == shard.index) part.push_back(all[q]);
  const std::vector<Answers> answers = answer_all(part, finished, solve_fem, solve_options);
  if (mpi_rank() != 0) return 0;
  write_record(out, {shard, options.command, digest_of(all)});
  const auto n_failed =
      std::count_if(answers.begin(), answers.end(), [](const Answers& found) { return found.failed(); });
  print(std::cout, "shard {} of {}: {} of {} solved{}, kept in {}\n", shard.index, shard.count, part.size(),
        all.size(), n_failed == 0 ? "" : fmt::format(", {} of them failed", n_failed), out);
  return 0;
}

void add_merge_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<MergeOptions>(
      program, chosen, "merge", "one report and one exit status of the shards of gate or tables", merge);
  command->add_option("folder", options->folders, "of each shard's --out")->required();
  command->add_option("--out", options->out, "folder for the files of the whole command's --out");
  command->add_option("--junit", options->junit, "of gate: file for the verdicts as JUnit's XML");
  command->add_flag("--annotate", options->annotate, "of gate: GitHub's annotations too");
  add_json_option(*command, options->json);
}

} // namespace springproof::compare
