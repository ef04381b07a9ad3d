#include "cases/case/input_file.hpp"
#include "compare/app/commands.hpp"
#include "compare/interact/recording.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"

#include <filesystem>
#include <fmt/format.h>

// What several commands have.
namespace springproof::compare {

std::map<std::string, std::string> case_files_in(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(cases_folder() + "/" + folder))
    if (entry.path().extension() == ".toml") files[entry.path().stem().string()] = entry.path().string();
  return files;
}

CLI::Option* add_set_option(CLI::App& command, std::vector<std::string>& settings, const std::string& text) {
  return command.add_option("--set", settings, text)->allow_extra_args(false);
}

CLI::Option* add_json_option(CLI::App& command, bool& json) {
  return command.add_flag("--json", json, "one JSON document on standard output, and nothing else there");
}

CLI::Option* add_workers_option(CLI::App& command, int& n_workers) {
  return command.add_option("--workers", n_workers, "processes that solve cases; without it one per core")
      ->check(CLI::Range(1, 1024));
}

CLI::Option* add_converge_option(CLI::App& command, int& meshes) {
  return command
      .add_flag("--converge{3}", meshes,
                "the limit from exactly N uniformly refined meshes (--converge=4; 3 by itself), with a table "
                "of them")
      ->check(CLI::Range(3, 9));
}

std::array<CLI::Option*, 2> add_displacement_options(CLI::App& command, DisplacementOptions& options) {
  CLI::Option* file = command.add_option(
      "--msm-displacements", options.file,
      "another simulator's displacements in place of our springs: .csv (x,y,z,ux,uy,uz) or a VTK file; of a "
      "case with [dynamics] its motion: .pvd, a folder of numbered files or .csv (time,x,y,z,ux,uy,uz)");
  command
      .add_flag("--interpolate", options.interpolate,
                "they are on a mesh of their own: interpolate in its cells, and say what that may add")
      ->needs(file);
  command.add_option("--array", options.array, "the name of the displacements among a VTK file's vectors")
      ->needs(file);
  CLI::Option* client =
      command
          .add_option("--client", options.client,
                      "NAME=COMMAND: a program that is asked in place of our springs, as judge asks it")
          ->excludes(file);
  return {file, client};
}

std::array<CLI::Option*, 2> add_step_options(CLI::App& command, ClientBudget& budget) {
  return {
      command.add_option("--step", budget.step, "step of clients whose body is to come to rest, s")
          ->check(number_between(1e-7, 1))
          ->capture_default_str(),
      command.add_option("--iterations", budget.iterations, "iterations a step; 0: each client's default")
          ->check(CLI::Range(0, 1'000'000))
          ->capture_default_str()};
}

CLI::Option* add_replay_option(CLI::App& command, std::string& recording) {
  return command.add_option(
      "--replay", recording,
      "a recording of interact: of pulls (NAME_pulls.csv), whose forces act on both models, or of "
      "tools (NAME_tools.csv), which move in both");
}

std::vector<Question> with_recording(std::vector<Question> questions, const std::string& recording) {
  if (recording.empty()) return questions;
  if (questions.size() != 1) throw cases::InputError("--replay: a recording is of one case");
  cases::Scene& scene = questions.front().scene;
  scene = with_recording(std::move(scene), cases::read_text_file(recording), recording);
  return questions;
}

CLI::Validator number_between(double lowest, double highest) {
  const auto check = [=](const std::string& text) {
    const auto number = cases::number_in<double>(text);
    const bool is_good = number && lowest <= *number && *number <= highest;
    return is_good
               ? std::string()
               : fmt::format("is {}, must be a number from {:g} to {:g}", one_line(text), lowest, highest);
  };
  return {check, fmt::format("FLOAT in [{:g} - {:g}]", lowest, highest)};
}

} // namespace springproof::compare
