#include "compare/commands.hpp"
#include "compare/pool/process_pool.hpp"
#include "compare/pool/solve_jobs.hpp"

namespace compare {

void add_worker_command(CLI::App& program, Action& chosen) {
  CLI::App* command = program.add_subcommand("worker", "solves what its parent process asks for");
  command->group(""); // not for users: left out of the help
  command->callback([&chosen] {
    end_with_parent();
    chosen = [] {
      serve_jobs(answer_job);
      return 0;
    };
  });
}

} // namespace compare
