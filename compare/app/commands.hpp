#pragma once

#include <CLI/CLI.hpp>
#include <functional>

/// The program's commands. Each adds its subcommand and options to the command line and, when it is the one
/// chosen, sets what is to be done after MPI has started. The answer is the exit status: 0 done, 1 an
/// expectation missed or a solve failed.
namespace springproof::compare {

using Action = std::function<int()>;

void add_describe_command(CLI::App& program, Action& chosen); ///< hidden: for the build
void add_design_command(CLI::App& program, Action& chosen);
void add_eigen_command(CLI::App& program, Action& chosen);
void add_export_command(CLI::App& program, Action& chosen);
void add_gate_command(CLI::App& program, Action& chosen);
void add_interact_command(CLI::App& program, Action& chosen);
void add_merge_command(CLI::App& program, Action& chosen);
void add_new_command(CLI::App& program, Action& chosen);
void add_run_command(CLI::App& program, Action& chosen);
void add_stress_command(CLI::App& program, Action& chosen);
void add_sweep_command(CLI::App& program, Action& chosen);
void add_tables_command(CLI::App& program, Action& chosen);
void add_worker_command(CLI::App& program, Action& chosen); ///< hidden: see solve/solve_jobs.hpp

/// The program's commands without those that --help leaves out.
inline std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// --converge, of the commands that hold springs against a limit: the number of meshes, 0 without it.
inline void add_converge_option(CLI::App& command, int& meshes) {
  command
      .add_flag("--converge{3}", meshes,
                "the limit from exactly N uniformly refined meshes (--converge=4; 3 by itself), with a table "
                "of them")
      ->check(CLI::Range(3, 9));
}

/// --msm-displacements and --interpolate, of the commands that take another simulator's results.
struct DisplacementOptions {
  std::string file; ///< empty: our springs are solved
  bool interpolate = false;
};

/// @return the first of the two
inline CLI::Option* add_displacement_options(CLI::App& command, DisplacementOptions& options) {
  CLI::Option* file = command.add_option(
      "--msm-displacements", options.file,
      "another simulator's displacements in place of our springs: .csv (x,y,z,ux,uy,uz) or a VTK file");
  command
      .add_flag("--interpolate", options.interpolate,
                "they are on a mesh of their own: interpolate in its cells, and say what that may add")
      ->needs(file);
  return file;
}

} // namespace springproof::compare
