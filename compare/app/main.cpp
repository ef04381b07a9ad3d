#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "compare/app/commands.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/solve/solvers.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <new>
#include <system_error>

using namespace springproof;

namespace {

enum ExitStatus { failed_solve = 1, wrong_input = 2, internal_error = 3 };

const char* const lost_output = "springproof: standard output cannot be written";

enum class BlasWarning { give, withhold };

int run_action(const compare::Action& action, BlasWarning warning) {
  compare::reserve_standard_streams();
  std::string message = lost_output;
  int status = wrong_input;
  try {
    // A process alone starts MPI with the first solver that needs it, which most commands do without.
    if (compare::is_under_mpi_launcher()) compare::solvers();
    const bool is_openblas = compare::use_one_blas_thread();
    if (compare::mpi_rank() == 0 && warning == BlasWarning::give && !is_openblas)
      std::cerr
          << "springproof: the BLAS in use is not OpenBLAS; the direct solvers will be several times slower "
             "(install libopenblas0-pthread)\n";
    compare::check_petsc_options();
    const auto colours = compare::coloured_output();
    const int done = action();
    std::cout.flush();
    if (std::cout) return done;
  } catch (const cases::InputError& error) {
    message = error.what();
  } catch (const std::bad_alloc&) {
    message = "springproof: not enough memory";
  } catch (const cases::SolveError& error) { // a design failed; failed cases are rows
    message = error.what();
    status = failed_solve;
  } catch (const std::system_error& error) { // a folder that cannot be read, a process that cannot be started
    message = std::string("springproof: ") + error.what();
  } catch (const std::exception& error) {
    message = std::string("springproof: internal error: ") + error.what();
    status = internal_error;
  }
  compare::give_up(compare::one_line(message), status);
  return status;
}

/// A command or an option that there is not, with the nearest one.
CLI::ParseError explained(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv) {
  const auto nearest = [](const std::string& word, const std::vector<std::string>& known) {
    const auto found = cases::nearest_name(word, known);
    return found ? "; did you mean \"" + *found + "\"?" : std::string();
  };
  const auto explanation = [&](const std::string& message) {
    return CLI::ParseError("springproof: " + compare::one_line(message), CLI::ExitCodes::InvalidError);
  };
  if (error.get_exit_code() == 0 || argc < 2) return error;
  const std::string name = argv[1];
  if (name.rfind("-", 0) == 0) return error;
  std::vector<std::string> known;
  for (const CLI::App* command : compare::commands_of(program)) known.push_back(command->get_name());
  const auto is_it = [&](const CLI::App* command) { return command->get_name() == name; };
  const std::vector<const CLI::App*> command = program.get_subcommands(is_it); // a hidden one too
  if (command.empty()) return explanation("there is no command \"" + name + "\"" + nearest(name, known));
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError)) return error;
  known.clear();
  for (const CLI::Option* option : command.front()->get_options())
    for (const std::string& known_name : option->get_lnames()) known.push_back("--" + known_name);
  for (int i = 2; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    if (word.rfind("--", 0) == 0 && std::count(known.begin(), known.end(), word) == 0)
      return explanation(name + " has no option \"" + word + "\"" + nearest(word, known));
  }
  return error;
}

/// Help, the version, or what is wrong with the command line.
int run_usage(const CLI::App& program, const CLI::ParseError& answer) {
  const int status = answer.get_exit_code() == 0 ? 0 : wrong_input;
  if (compare::is_under_mpi_launcher()) { // one rank says it for all
    const auto tell = [&] {
      if (compare::mpi_rank() == 0) program.exit(answer);
      return status;
    };
    return run_action(tell, BlasWarning::withhold);
  }
  program.exit(answer);
  std::cout.flush();
  if (std::cout) return status;
  std::cerr << lost_output << std::endl;
  return wrong_input;
}

} // namespace

int main(int argc, char** argv) {
  constexpr double megabytes = 300; // 245 are taken until springs are solved, 134 of them by OpenBLAS
  if (const std::string reason = compare::why_not_to_start(megabytes); !reason.empty()) {
    std::cerr << "springproof: " << reason << std::endl;
    std::_Exit(wrong_input); // OpenBLAS' threads, which look for memory, would be waited for
  }
  CLI::App program{"springproof: mass-spring models of soft tissue against finite elements, measured"};
  program.set_version_flag("--version", compare::program_version() + " (" + compare::program_commit() + ")");
  program.require_subcommand(1);
  compare::Action chosen;
  for (const auto add :
       {compare::add_run_command, compare::add_gate_command, compare::add_interact_command,
        compare::add_new_command, compare::add_design_command, compare::add_fit_command,
        compare::add_eigen_command, compare::add_stress_command, compare::add_sweep_command,
        compare::add_tables_command, compare::add_merge_command, compare::add_export_command,
        compare::add_judge_command, compare::add_league_command, compare::add_dossier_command,
        compare::add_describe_command, compare::add_worker_command})
    add(program, chosen);
  for (CLI::App* command : program.get_subcommands(nullptr))
    if (CLI::Option* out = command->get_option_no_throw("--out"))
      out->check([](const std::string& folder) { return folder.empty() ? "names no folder" : ""; });
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& answer) {
    return run_usage(program, explained(program, answer, argc, argv));
  }
  // A worker's parent has given the warning.
  return run_action(chosen, program.got_subcommand("worker") ? BlasWarning::withhold : BlasWarning::give);
}
