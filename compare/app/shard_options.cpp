#include "compare/app/shard_options.hpp"

#include "compare/error_bars/auto_fem.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"

#include <algorithm>
#include <iostream>

namespace springproof::compare {

namespace {

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

void print_shard(const Shard& shard, std::size_t n_done, std::size_t n_all, std::size_t n_failed,
                 const std::string& out) {
  print(std::cout, "shard {} of {}: {} of {} solved{}, kept in {}\n", shard.index, shard.count, n_done, n_all,
        n_failed == 0 ? "" : fmt::format(", {} of them failed", n_failed), out);
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
  print_shard(shard, part.size(), all.size(), static_cast<std::size_t>(n_failed), out);
  return 0;
}

} // namespace springproof::compare
