#include "compare/solve/finished.hpp"

#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/answer_bytes.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/frame.hpp"
#include "compare/solve/kept.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <mpi.h>
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

/// The bytes that a file keeps for a question, if they can be read; empty otherwise.
/// @param read  answers_from() or answer_from()
template<class Read>
std::string bytes_in(const std::string& path, const std::string& identity, const cases::HexMesh& mesh,
                     const Read& read) {
  try {
    std::string bytes = read_kept(path, identity);
    if (!bytes.empty()) read(bytes, mesh);
    return bytes;
  } catch (const std::exception& error) {
    print(std::cerr, "{}: {}; the case is solved again\n", path, error.what());
    return "";
  }
}

/// Rank 0's text on every rank.
std::string from_rank_0(std::string text) {
  unsigned long size = text.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, MPI_COMM_WORLD);
  text.resize(size);
  constexpr unsigned long most = 1ul << 30; // MPI counts in int
  for (unsigned long at = 0; at < size; at += most)
    MPI_Bcast(text.data() + at, static_cast<int>(std::min(most, size - at)), MPI_CHAR, 0, MPI_COMM_WORLD);
  return text;
}

} // namespace

FinishedCases::FinishedCases(const std::string& folder, const std::vector<Question>& questions,
                             FileNames names)
    : folder_(folder), names_(names) {
  if (folder.empty()) return;
  std::set<std::string> taken;
  for (const Question& question : questions) {
    const cases::Case& definition = question.scene.definition;
    if (names == FileNames::of_cases && !taken.insert(definition.name).second)
      throw cases::InputError(
          fmt::format("{}: another case is named \"{}\" too, and --out has one file a name", definition.file,
                      definition.name));
  }
  claim_folder(folder);
  claim_subfolder(folder, "solved");
}

std::optional<Answers> FinishedCases::find(const Question& question) const {
  if (folder_.empty()) return std::nullopt;
  const std::string bytes =
      from_rank_0(mpi_rank() == 0 ? bytes_in(path_of(folder_, question, names_), identity(question),
                                             question.scene.mesh, answers_from)
                                  : "");
  if (bytes.empty()) return std::nullopt;
  Answers answers = answers_from(bytes, question.scene.mesh);
  if (answers.failed()) return std::nullopt;
  if (mpi_rank() == 0)
    print(std::cerr, "{}: solved already, taken from the earlier results in the same folder\n",
          question.scene.definition.name);
  return answers;
}

void FinishedCases::keep(const Question& question, const Answers& answers) const {
  if (folder_.empty()) return;
  write_kept(path_of(folder_, question, names_), identity(question), cases::to_bytes(answers));
  if (!answers.refined || answers.failed()) return;
  cases::Fem fem = answers.resolved;
  for (const int refine : answers.refined->refine) {
    fem.refine = refine;
    std::error_code not_there;
    std::filesystem::remove(path_of_mesh(folder_, identity_of_mesh(question, fem)), not_there);
  }
}

KeptMeshes FinishedCases::meshes_in(const std::string& folder, const Question& question) {
  if (folder.empty()) return {};
  const auto find = [folder, &question](const cases::Fem& fem) -> std::optional<Answer> {
    const std::string identity = identity_of_mesh(question, fem);
    const std::string path = path_of_mesh(folder, identity);
    const std::string bytes =
        from_rank_0(mpi_rank() == 0 ? bytes_in(path, identity, question.scene.mesh, answer_from) : "");
    if (bytes.empty()) return std::nullopt;
    if (mpi_rank() == 0)
      print(std::cerr,
            "{}: the mesh refined {} times is solved already, taken from the earlier results in the same "
            "folder\n",
            question.scene.definition.name, fem.refine);
    return answer_from(bytes, question.scene.mesh);
  };
  const auto keep = [folder, &question](const cases::Fem& fem, const Answer& answer) {
    const std::string identity = identity_of_mesh(question, fem);
    if (mpi_rank() == 0) write_kept(path_of_mesh(folder, identity), identity, cases::to_bytes(answer));
  };
  return {find, keep};
}

Answers kept_answers(const std::string& folder, const Question& question, FileNames names) {
  const std::string path = path_of(folder, question, names);
  try {
    const std::string bytes = read_kept(path, identity(question));
    if (bytes.empty()) throw std::runtime_error("has no answers to " + question.scene.definition.name);
    return answers_from(bytes, question.scene.mesh);
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
