#include "compare/solve/finished.hpp"

#include "cases/case/input_file.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/kept.hpp"
#include "compare/solve/ranks.hpp"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <set>

namespace springproof::compare {

namespace {

std::string identity(const Question& question) {
  return identity_of(cases::to_bytes<cereal::BinaryOutputArchive>(question));
}

std::string path_of(const std::string& folder, const Question& question, FileNames names) {
  const std::string solved = folder + "/solved/";
  return solved + (names == FileNames::of_cases ? question.scene.definition.name : identity(question));
}

/// File of an answer on one of a question's meshes.
std::string path_of_mesh(const std::string& folder, const std::string& identity) {
  return folder + "/solved/mesh-" + identity;
}
std::string identity_of_mesh(const Question& question, const cases::Fem& fem) {
  return identity({with_fem(question.scene, fem), question.request});
}

/// Collective.
/// @return nothing if there is no result for the question; with a line on standard error if it is damaged
template<class Result>
std::optional<Result> find_kept(const std::string& path, const std::string& identity,
                                const cases::HexMesh& mesh) {
  std::optional<Result> found;
  if (mpi_rank() == 0) try {
      const std::string bytes = read_kept(path, identity);
      if (!bytes.empty()) found = result_from<Result>(bytes, mesh);
    } catch (const std::exception& error) {
      print(std::cerr, "{}: {}; the case is solved again\n", path, error.what());
    }
  if (!on_all_ranks(mpi_rank() != 0 || found)) return std::nullopt;
  return shared_from_rank_0<Result>(mesh, [&] { return std::move(*found); });
}

/// Collective.  @throws InputError if the file cannot be written
template<class Result>
void keep_whole(const std::string& path, const std::string& identity, const Result& result) {
  const Result whole = gathered(result);
  run_on_all_ranks([&] {
    if (mpi_rank() == 0) write_kept(path, identity, cases::to_bytes(whole));
  });
}

} // namespace

const std::string& this_program() {
  static const std::string identity =
      program_version() + " " + program_commit() + " " + digest(read_file("/proc/self/exe"));
  return identity;
}

std::string identity_of(const std::string& question) {
  const char* petsc = std::getenv("PETSC_OPTIONS");
  return digest(cases::to_bytes<cereal::BinaryOutputArchive>(this_program(), std::string(petsc ? petsc : ""),
                                                             question));
}

void write_kept(const std::string& path, const std::string& identity, const std::string& result) {
  const std::string content = kept_text(identity, result);
  write_file(path, [&](std::ostream& out) { out << content; });
}

std::string read_kept(const std::string& path, const std::string& identity) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return "";
  return result_in(read_file(path), identity);
}

FinishedCases::FinishedCases(const std::string& folder, const std::vector<Question>& questions,
                             FileNames names)
    : folder_(folder), names_(names) {
  if (folder.empty()) return;
  std::set<std::string> taken;
  for (const Question& question : questions) {
    const cases::Case& definition = question.scene.definition;
    if (names == FileNames::of_cases && !taken.insert(cases::in_small_letters(definition.name)).second)
      throw cases::InputError(fmt::format("{}: another case is named \"{}\" too (small letters and capitals "
                                          "are one on some disks), and --out has one file a name",
                                          definition.file, definition.name));
  }
  claim_folder(folder);
  claim_subfolder(folder, "solved");
}

std::optional<Answers> FinishedCases::find(const Question& question) const {
  if (folder_.empty()) return std::nullopt;
  std::optional<Answers> answers =
      find_kept<Answers>(path_of(folder_, question, names_), identity(question), question.scene.mesh);
  if (!answers || answers->failed()) return std::nullopt;
  if (mpi_rank() == 0)
    print(std::cerr, "{}: solved already, taken from the earlier results in the same folder\n",
          question.scene.definition.name);
  return answers;
}

void FinishedCases::keep(const Question& question, const Answers& answers) const {
  if (folder_.empty()) return;
  keep_whole(path_of(folder_, question, names_), identity(question), answers);
  if (mpi_rank() != 0 || !answers.refined || answers.failed()) return;
  cases::Fem fem = answers.resolved;
  for (const int refine : answers.refined->refine) {
    fem.refine = refine;
    std::error_code not_there;
    std::filesystem::remove(path_of_mesh(folder_, identity_of_mesh(question, fem)), not_there);
  }
}

KeptMeshes FinishedCases::meshes_in(const std::string& folder, const Question& question) {
  if (folder.empty()) return {};
  const auto find = [folder, &question](const cases::Fem& fem) {
    const std::string identity = identity_of_mesh(question, fem);
    std::optional<Answer> found =
        find_kept<Answer>(path_of_mesh(folder, identity), identity, question.scene.mesh);
    if (found && mpi_rank() == 0)
      print(std::cerr,
            "{}: the mesh refined {} times is solved already, taken from the earlier results in the same "
            "folder\n",
            question.scene.definition.name, fem.refine);
    return found;
  };
  const auto keep = [folder, &question](const cases::Fem& fem, const Answer& answer) {
    const std::string identity = identity_of_mesh(question, fem);
    keep_whole(path_of_mesh(folder, identity), identity, answer);
  };
  return {find, keep};
}

Answers kept_answers(const std::string& folder, const Question& question, FileNames names) {
  const std::string path = path_of(folder, question, names);
  try {
    const std::string bytes = read_kept(path, identity(question));
    if (bytes.empty()) throw std::runtime_error("has no answers to the case as it is now");
    return result_from<Answers>(bytes, question.scene.mesh);
  } catch (const std::exception& error) {
    throw cases::InputError(path + ": " + error.what());
  }
}

std::string digest_of(const std::vector<Question>& questions) {
  std::string identities;
  for (const Question& question : questions) identities += identity(question);
  return digest(identities);
}

} // namespace springproof::compare
