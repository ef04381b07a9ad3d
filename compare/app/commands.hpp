#pragma once

#include "compare/client/scene_message.hpp"
#include "compare/solve/solve_jobs.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <map>
#include <memory>

/// The program's commands. Each adds its subcommand and options to the command line and, when it is the one
/// chosen, sets what is to be done after MPI has started. The answer is the exit status: 0 done, 1 an
/// expectation missed or a solve failed.
namespace springproof::compare {

using Action = std::function<int()>;

void add_describe_command(CLI::App& program, Action& chosen); ///< hidden: for the build
void add_design_command(CLI::App& program, Action& chosen);
void add_dossier_command(CLI::App& program, Action& chosen);
void add_eigen_command(CLI::App& program, Action& chosen);
void add_export_command(CLI::App& program, Action& chosen);
void add_fit_command(CLI::App& program, Action& chosen);
void add_gate_command(CLI::App& program, Action& chosen);
void add_interact_command(CLI::App& program, Action& chosen);
void add_judge_command(CLI::App& program, Action& chosen);
void add_league_command(CLI::App& program, Action& chosen);
void add_merge_command(CLI::App& program, Action& chosen);
void add_new_command(CLI::App& program, Action& chosen);
void add_run_command(CLI::App& program, Action& chosen);
void add_stress_command(CLI::App& program, Action& chosen);
void add_sweep_command(CLI::App& program, Action& chosen);
void add_tables_command(CLI::App& program, Action& chosen);
void add_worker_command(CLI::App& program, Action& chosen); ///< hidden: see solve/solve_jobs.hpp

// The process of a command, and its job's other ranks.

/// Keeps the number of a closed standard stream from the next file that is opened: writing to it fails.
void reserve_standard_streams();

/// Ends a rank that meets an error. Rank 0 tells it. Returns when all ranks meet one; when some do not
/// within two seconds, ends them all with this status, because they may be waiting for this rank for ever.
void give_up(const std::string& message, int status);

/// Colours verdicts at the beginnings of lines of std::cout: met green, missed and failed red, warnings
/// yellow. Only on a terminal, unless NO_COLOR is set (no-color.org) or TERM is "dumb".
/// @return an object whose destruction ends the colouring
std::shared_ptr<void> coloured_output();

/// The program's commands without those that --help leaves out.
inline std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// Adds a command that is run with its options when it is the one chosen.
/// @return the command, and the options that its command line sets
template<class Options>
std::pair<CLI::App*, std::shared_ptr<Options>>
add_command(CLI::App& program, Action& chosen, const std::string& name, const std::string& description,
            int (*run)(const Options&)) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = program.add_subcommand(name, description);
  command->callback([options, run, &chosen] { chosen = [options, run] { return run(*options); }; });
  return {command, options};
}

/// Files of the cases in a folder of the program's cases, by their names.
std::map<std::string, std::string> case_files_in(const std::string& folder);

/// --set.
CLI::Option* add_set_option(CLI::App& command, std::vector<std::string>& settings, const std::string& text);
/// --json, of the commands that print nothing else then.
CLI::Option* add_json_option(CLI::App& command, bool& json);
/// --workers: the number of worker processes, 0 without it.
CLI::Option* add_workers_option(CLI::App& command, int& n_workers);
/// --converge, of the commands that hold springs against a limit: the number of meshes, 0 without it.
CLI::Option* add_converge_option(CLI::App& command, int& meshes);

/// --msm-displacements, --interpolate, --array and --client, of the commands that take another simulator's
/// results.
struct DisplacementOptions {
  std::string file;   ///< empty: our springs are solved, or a client is asked
  std::string client; ///< NAME=COMMAND; empty: there is none
  bool has_others() const { return !file.empty() || !client.empty(); }
  bool interpolate = false;
  std::string array; ///< empty: the one that the reader finds
};
/// @return --msm-displacements and --client
std::array<CLI::Option*, 2> add_displacement_options(CLI::App& command, DisplacementOptions& options);

/// --step and --iterations, of the commands that ask clients.
std::array<CLI::Option*, 2> add_step_options(CLI::App& command, ClientBudget& budget);

/// --replay, of the commands that solve both models of what was pulled.
CLI::Option* add_replay_option(CLI::App& command, std::string& recording);

/// The one question of a command with --replay, with the recording's forces as loads.
/// @param recording  a file of `interact`; empty: the questions stay as they are
/// @throws cases::InputError where there are several questions, or the file is no recording of the case
std::vector<Question> with_recording(std::vector<Question> questions, const std::string& recording);

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

/// How the command line names a material, a cell and a method.
struct DesignOptions {
  std::string case_file;
  std::vector<std::string> settings; ///< keys of the case
  double youngs_modulus = 0,
         poissons_ratio = -2; ///< as if left out: both are required without another material
  double edge = 1;
  double split = -1, beta = -1; ///< left out
  std::string method;
  std::string element = "q1";
  std::vector<double> ogden_mu, ogden_alpha, mooney_rivlin, yeoh;
  double neo_hookean = 0;
  std::string curve_file;
  std::string curve_strain, curve_stress, curve_unit; ///< names of its columns' msm::CurveStrain and so on
  std::optional<double> largest_strain;
  std::vector<std::string> paths;   ///< paths of the multi-load method; empty: all
  std::vector<double> strain_range; ///< two, or left out
  std::string law;                  ///< law of the multi-load method; empty: the case's or Hooke's
  bool springs_only = false;        ///< the multi-load method without its volume term
};

void add_design_options(CLI::App& command, DesignOptions& options);

/// --curve with --strain, --stress and --unit of its columns.  @return --curve
CLI::Option* add_curve_options(CLI::App& command, DesignOptions& options);
/// The file of --curve.  @throws InputError where the options do not say what its columns are
msm::UniaxialCurve measured_curve(const DesignOptions& options);

/// Names of designs, or "all", as --designs.
CLI::Option* add_designs_option(CLI::App& command, std::vector<std::string>& names, const std::string& text);

/// How many materials the options name, apart from a case file's.
int n_materials(const DesignOptions& options);

/// The designs that are asked for; "all": every one that is made from a material, and the case's own.
std::vector<cases::Design> designs_of(const std::vector<std::string>& names, const cases::Case& definition);

/// @throws InputError for a material that is missing, given twice or has no meaning
msm::DesignRequest request_from(const DesignOptions& options);

/// Checks that an option's value is a number between two others; CLI::Range lets nan pass.
CLI::Validator number_between(double lowest, double highest);

} // namespace springproof::compare
