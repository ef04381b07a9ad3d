#include "cases/case/error.hpp"
#include "compare/app/commands.hpp"
#include "compare/provenance/machine.hpp"
#include "fem_reference/session.hpp"

#include <iostream>

using namespace springproof;

namespace {

enum ExitStatus { wrong_input = 2, internal_error = 3 };

enum class BlasWarning { give, withhold };

int run_action(const compare::Action& action, BlasWarning warning) {
  const fem_reference::Session session;
  const bool is_openblas = compare::use_one_blas_thread();
  if (session.rank() == 0 && warning == BlasWarning::give && !is_openblas)
    std::cerr
        << "springproof: the BLAS in use is not OpenBLAS; the direct solvers will be several times slower "
           "(install libopenblas0-pthread)\n";
  std::string message = "springproof: standard output cannot be written";
  int status = wrong_input;
  try {
    const int done = action();
    std::cout.flush();
    if (std::cout) return done;
  } catch (const cases::InputError& error) {
    message = error.what();
  } catch (const std::exception& error) {
    message = std::string("springproof: internal error: ") + error.what();
    status = internal_error;
  }
  session.give_up(message, status);
  return status;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App program{"springproof: mass-spring models of soft tissue against finite elements, measured"};
  program.set_version_flag("--version", compare::program_version() + " (" + compare::program_commit() + ")");
  program.require_subcommand(1);
  compare::Action chosen;
  for (const auto add : {compare::add_run_command, compare::add_gate_command, compare::add_new_command,
                         compare::add_design_command, compare::add_eigen_command, compare::add_stress_command,
                         compare::add_sweep_command, compare::add_tables_command, compare::add_merge_command,
                         compare::add_worker_command})
    add(program, chosen);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = program.exit(error);
    return status == 0 ? 0 : wrong_input;
  }
  // A worker's parent has given the warning.
  return run_action(chosen, program.got_subcommand("worker") ? BlasWarning::withhold : BlasWarning::give);
}
