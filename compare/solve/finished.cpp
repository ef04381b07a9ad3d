#include "compare/solve/finished.hpp"

#include "compare/provenance/mpi_rank.hpp"
#include "compare/provenance/version.hpp"
#include "compare/solve/side_bytes.hpp"
#include "compare/write/whole_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <mpi.h>

namespace springproof::compare {

namespace {

/// The commit does not tell one build of uncommitted changes from another; the program's own bytes do.
const std::string& this_program() {
  static const std::string identity =
      fmt::format("{} {:x}", program_commit(), std::hash<std::string>()(read_file("/proc/self/exe")));
  return identity;
}

/// All that a case's answers depend on, as a text that is compared whole.
std::string identity_of(const cases::Case& definition, const Request& request) {
  const char* petsc = std::getenv("PETSC_OPTIONS");
  std::string text = fmt::format("springproof {}\nonly {} meshes {} peer '{}' petsc '{}'\n", this_program(),
                                 request.only ? static_cast<int>(*request.only) : -1, request.meshes,
                                 request.peer, petsc ? petsc : "");
  for (const std::string& setting : request.settings) text += "set " + setting + "\n";
  text += read_file(definition.file);
  if (const auto* mesh = std::get_if<cases::MeshFile>(&definition.body)) text += read_file(mesh->path);
  if (const auto* voxels = std::get_if<cases::Voxels>(&definition.body)) text += read_file(voxels->path);
  return fmt::format("{}\n", text.size()) + text;
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

std::string FinishedCases::path_of(const cases::Case& definition) const {
  return folder_ + "/solved/" + definition.name;
}

std::optional<Answers> FinishedCases::find(const cases::Case& definition, const Request& request) const {
  if (folder_.empty()) return std::nullopt;
  const int rank = mpi_rank();
  std::string bytes;
  if (rank == 0 && std::filesystem::is_regular_file(path_of(definition))) {
    const std::string content = read_file(path_of(definition)), identity = identity_of(definition, request);
    if (content.compare(0, identity.size(), identity) == 0) bytes = content.substr(identity.size());
  }
  bytes = from_rank_0(bytes);
  if (bytes.empty()) return std::nullopt;
  return from_bytes(bytes);
}

void FinishedCases::keep(const cases::Case& definition, const Request& request,
                         const Answers& answers) const {
  if (folder_.empty() || answers.failed()) return;
  write_file(path_of(definition),
             [&](std::ostream& out) { out << identity_of(definition, request) << to_bytes(answers); });
}

} // namespace springproof::compare
