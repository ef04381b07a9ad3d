#include "compare/app/commands.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/solve/solve_jobs.hpp"
#include "compare/sweep/sweep.hpp"

#include <csignal>
#include <memory>
#include <sys/prctl.h>

namespace springproof::compare {

void add_worker_command(CLI::App& program, Action& chosen) {
  CLI::App* command = program.add_subcommand("worker", "solves what its parent process asks for");
  command->group(""); // not for users: left out of the help
  auto is_timing = std::make_shared<bool>(false);
  command->add_flag("--timing", *is_timing, "variants of a sweep in place of cases");
  command->callback([is_timing, &chosen] {
    prctl(PR_SET_PDEATHSIG, SIGKILL); // it ends with the process that started it, even in the midst of a job
    chosen = [is_timing] {
      if (*is_timing)
        serve_jobs(answer_timing_job);
      else
        serve_jobs([](const std::string& job) { return answer_job(job, solve_fem); });
      return 0;
    };
  });
}

} // namespace springproof::compare
