#pragma once

#include "compare/solve/comparison.hpp"

#include <functional>
#include <string>
#include <vector>

/// Cases solved side by side on the machine's cores: what the commands that solve many cases share.
namespace springproof::compare {

/// A case file, settings for it and the side to solve: all that a solve depends on.
struct SolveJob {
  std::string case_file;             ///< as read_case() opens it
  std::vector<std::string> settings; ///< as for `run --set`
  Only side = Only::both;
  bool operator<(const SolveJob& other) const;
};

struct SolveOptions {
  int n_workers = 0;                      ///< worker processes; 0: one per core
  std::string program = "/proc/self/exe"; ///< whose hidden command `worker` serves
  /// Told each job and what came of it as soon as it is there, so that it can be kept; may be empty.
  std::function<void(std::size_t job, const Comparison&)> on_solved = {};
};

/// Solves every job and measures it. Numbers do not depend on the number of workers, to the last bit. Jobs
/// are handed out dearest first. Whatever goes wrong in a job, a crash of its process included, is a failed
/// side with its reason, and the others go on. Under MPI with several ranks the jobs run in this process one
/// after the other, each distributed (collective).
/// @param progress  told the number of jobs done and in all
std::vector<Comparison> solve_jobs(const std::vector<SolveJob>& jobs, const SolveOptions& options,
                                   const std::function<void(int done, int all)>& progress);

/// What a worker does with a job's line: bytes that hold both sides and the design.
/// @throws InputError, SolveError, std::runtime_error for a line that is no job
std::string answer_job(const std::string& line);

int cores(); ///< of the machine, at least 1

} // namespace springproof::compare
