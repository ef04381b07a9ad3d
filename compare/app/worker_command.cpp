#include "compare/app/commands.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/sweep/sweep.hpp"

#include <csignal>
#include <sys/prctl.h>

namespace springproof::compare {

namespace {

int serve(const bool& is_timing) {
  prctl(PR_SET_PDEATHSIG, SIGKILL); // it ends with the process that started it, even in the midst of a job
  if (is_timing)
    serve_jobs(answer_timing_job);
  else
    serve_jobs([](const std::string& job) { return answer_job(job, solve_fem); });
  return 0;
}

} // namespace

void add_worker_command(CLI::App& program, Action& chosen) {
  const auto [command, is_timing] =
      add_command(program, chosen, "worker", "solves what its parent process asks for", serve);
  command->group(""); // not for users: left out of the help
  command->add_flag("--timing", *is_timing, "variants of a sweep in place of cases");
}

} // namespace springproof::compare
