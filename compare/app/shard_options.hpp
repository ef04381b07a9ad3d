#pragma once

#include "compare/solve/shard.hpp"
#include "compare/solve/solve_jobs.hpp"

#include <CLI/CLI.hpp>

namespace springproof::compare {

/// What a command that can be divided knows of it.
struct ShardOptions {
  std::string part;                 ///< argument of `--shard`; empty: the whole
  std::vector<std::string> folders; ///< shards that `merge` takes results from
  std::vector<std::string> command; ///< its name and the arguments that all shards have in common
};

/// Adds `--shard I/N`, which needs --out, and the hidden option that `merge` uses.
/// @param not_divided  options of the whole command's output, which a shard has not
/// @return the hidden option
CLI::Option* add_shard_options(CLI::App& command, ShardOptions& options, CLI::Option* out,
                               const std::vector<CLI::Option*>& not_divided);

/// Solves the part of the questions that is a shard's, keeps what was found and the shard's record in the
/// folder, and prints one line. Collective over MPI_COMM_WORLD.
/// @return the exit status: 0, whatever was found: `merge` judges
int solve_shard(const ShardOptions& options, const std::vector<Question>& all, FileNames names,
                const std::string& out, const SolveOptions& solve_options);

} // namespace springproof::compare
