#include "compare/solve/finished.hpp"

#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/frame.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <mpi.h>
#include <set>

namespace springproof::compare {

namespace {

/// First line of a kept file; a frame of identity and answers follows. To be counted up when the fields of
/// compare/solve/fields.hpp change their meaning.
const std::string heading = "springproof answers, format 1\n";

/// The commit does not tell one build of uncommitted changes from another; the program's own bytes do.
const std::string& this_program() {
  static const std::string identity = program_commit() + " " + digest(read_file("/proc/self/exe"));
  return identity;
}

/// Of all that answers depend on. Meshes are in it as they were read, whatever files gmsh took them from; the
/// names of files and the lines of the case file are not.
std::string identity_of(const Question& question) {
  const char* petsc = std::getenv("PETSC_OPTIONS");
  return digest(cases::to_bytes<cereal::BinaryOutputArchive>(this_program(), std::string(petsc ? petsc : ""),
                                                             question));
}

/// The frame of answers in a file; empty if there is none for this question.
std::string answers_in(const std::string& path, const std::string& identity) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return "";
  try {
    std::string content = read_file(path);
    if (content.compare(0, heading.size(), heading) != 0)
      throw std::runtime_error("has another format than this program's");
    content.erase(0, heading.size());
    const std::optional<Frame> frame = take_frame(content);
    if (!frame || !content.empty()) throw std::runtime_error("is damaged");
    return frame->kind == identity ? frame->content : "";
  } catch (const std::exception& error) {
    std::cerr << path << ": " << error.what() << "; the case is solved again\n";
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

FinishedCases::FinishedCases(const std::string& folder, const std::vector<Question>& questions)
    : folder_(folder) {
  if (folder.empty()) return;
  std::set<std::string> names;
  for (const Question& question : questions) {
    const cases::Case& definition = question.scene.definition;
    if (!names.insert(definition.name).second)
      throw cases::InputError(
          fmt::format("{}: another case is named \"{}\" too, and --out has one file a name", definition.file,
                      definition.name));
  }
  claim_folder(folder);
  claim_folder(folder + "/solved");
}

std::string FinishedCases::path_of(const Question& question) const {
  return folder_ + "/solved/" + question.scene.definition.name;
}

std::optional<Answers> FinishedCases::find(const Question& question) const {
  if (folder_.empty()) return std::nullopt;
  const std::string bytes =
      from_rank_0(mpi_rank() == 0 ? answers_in(path_of(question), identity_of(question)) : "");
  if (bytes.empty()) return std::nullopt;
  if (mpi_rank() == 0)
    std::cerr << question.scene.definition.name
              << ": solved already, taken from the earlier results in the same folder\n";
  Answers answers;
  cases::from_bytes(bytes, answers);
  return answers;
}

void FinishedCases::keep(const Question& question, const Answers& answers) const {
  if (folder_.empty() || answers.failed()) return;
  const std::string content = framed({identity_of(question), cases::to_bytes(answers)});
  write_file(path_of(question), [&](std::ostream& out) { out << heading << content; });
}

} // namespace springproof::compare
