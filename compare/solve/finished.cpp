#include "compare/solve/finished.hpp"

#include "cases/case/rows.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/frame.hpp"
#include "compare/solve/kept.hpp"
#include "compare/solve/kept_parts.hpp"

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

} // namespace

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
      find_kept_answers(path_of(folder_, question, names_), identity(question), question.scene.mesh);
  if (!answers || answers->failed()) return std::nullopt;
  if (mpi_rank() == 0)
    print(std::cerr, "{}: solved already, taken from the earlier results in the same folder\n",
          question.scene.definition.name);
  return answers;
}

void FinishedCases::keep(const Question& question, const Answers& answers) const {
  if (folder_.empty()) return;
  write_kept_parts(path_of(folder_, question, names_), identity(question), answers);
  if (!answers.refined || answers.failed()) return;
  cases::Fem fem = answers.resolved;
  for (const int refine : answers.refined->refine) {
    fem.refine = refine;
    remove_kept_parts(path_of_mesh(folder_, identity_of_mesh(question, fem)));
  }
}

KeptMeshes FinishedCases::meshes_in(const std::string& folder, const Question& question) {
  if (folder.empty()) return {};
  const auto find = [folder, &question](const cases::Fem& fem) {
    const std::string identity = identity_of_mesh(question, fem);
    std::optional<Answer> found =
        find_kept_answer(path_of_mesh(folder, identity), identity, question.scene.mesh);
    if (found && mpi_rank() == 0)
      print(std::cerr,
            "{}: the mesh refined {} times is solved already, taken from the earlier results in the same "
            "folder\n",
            question.scene.definition.name, fem.refine);
    return found;
  };
  const auto keep = [folder, &question](const cases::Fem& fem, const Answer& answer) {
    const std::string identity = identity_of_mesh(question, fem);
    write_kept_parts(path_of_mesh(folder, identity), identity, answer);
  };
  return {find, keep};
}

Answers kept_answers(const std::string& folder, const Question& question, FileNames names) {
  const std::string path = path_of(folder, question, names);
  try {
    return read_kept_answers(path, identity(question), question.scene.mesh);
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
