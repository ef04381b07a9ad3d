#pragma once

#include "compare/solve/solve.hpp"

#include <functional>
#include <string>
#include <vector>

/// Cases solved side by side on the machine's cores: what the commands that solve many cases share.
namespace springproof::compare {

/// A case file, settings for it and what is asked: all that a solve depends on.
struct SolveJob {
  std::string case_file;             ///< as read_case() opens it
  std::vector<std::string> settings; ///< as for `run --set`
  std::optional<cases::Side> only;   ///< absent: both sides
  int meshes = 0;                    ///< of the finite elements' own error; 0: none
  bool operator<(const SolveJob& other) const;
};

/// A job's scene, and what solving it found.
struct Solved {
  cases::Scene scene;
  Answers answers;
};

struct SolveOptions {
  int n_workers = 0;                      ///< worker processes; 0: one per core
  std::string program = "/proc/self/exe"; ///< whose hidden command `worker` serves
  /// Told each job and what came of it as soon as it is there, so that it can be kept; may be empty.
  std::function<void(std::size_t job, const Solved&)> on_solved = {};
};

/// Solves every job. Numbers do not depend on the number of workers, to the last bit. Jobs
/// are handed out dearest first. Whatever goes wrong in a job, a crash of its process included, is a failed
/// side with its reason, and the others go on. Under MPI with several ranks the jobs run in this process one
/// after the other, each distributed (collective).
/// @param solve_fem  as for solve(); workers have their own
/// @param progress   told the number of jobs done and in all
std::vector<Solved> solve_jobs(const std::vector<SolveJob>& jobs, SolveFem solve_fem,
                               const SolveOptions& options,
                               const std::function<void(int done, int all)>& progress);

/// What a worker does with a job's line: bytes that hold the answers.
/// @throws InputError, SolveError, std::runtime_error for a line that is no job
std::string answer_job(const std::string& line, SolveFem solve_fem);

int cores(); ///< of the machine, at least 1

} // namespace springproof::compare
