#include "compare/solve/kept.hpp"

#include "cases/case/input_file.hpp"
#include "cases/case/installation.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/ranks.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iostream>
#include <numeric>
#include <set>

namespace springproof::compare {

namespace {

/// Digest of a question's bytes, this program and PETSC_OPTIONS.
std::string identity(const Question& question) {
  const char* petsc = std::getenv("PETSC_OPTIONS");
  return digest(
      cases::to_bytes<cereal::BinaryOutputArchive>(this_program(), std::string(petsc ? petsc : ""),
                                                   cases::to_bytes<cereal::BinaryOutputArchive>(question)));
}

std::string path_of(const std::string& folder, const Question& question, FileNames names) {
  return folder + "/solved/" +
         (names == FileNames::of_cases ? question.scene.definition.name : identity(question));
}

/// File of an answer on one of a question's meshes.
std::string path_of_mesh(const std::string& folder, const std::string& identity) {
  return folder + "/solved/mesh-" + identity;
}
std::string identity_of_mesh(const Question& question, const cases::Fem& fem) {
  return identity({with_fem(question.scene, fem), question.request});
}

/// @return the result in a file; empty if there is no file, or it is the result of another question
/// @throws std::runtime_error if it is of another format, or damaged
std::string read_kept(const std::string& path, const std::string& identity) {
  std::error_code unreadable;
  return std::filesystem::is_regular_file(path, unreadable) ? result_in(read_file(path), identity) : "";
}

/// Collective.
/// @return nothing if there is no result for the question; with a line on standard error if it is damaged
template<class Result>
std::optional<Result> find_kept(const std::string& path, const std::string& identity,
                                const cases::Mesh& mesh) {
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
    if (mpi_rank() == 0)
      write_file(path, [&](std::ostream& out) { out << kept_text(identity, cases::to_bytes(whole)); });
  });
}

std::string record_file(const std::string& folder) {
  return folder + "/shard.json";
}

ShardRecord read_record(const std::string& folder) {
  const std::string file = record_file(folder);
  if (!std::filesystem::exists(file))
    throw cases::InputError(folder +
                            ": has no shard.json: the shard has not finished, or this is no shard's folder");
  try {
    return record_from(read_file(file));
  } catch (const std::exception& error) {
    throw cases::InputError(file + ": is no shard's record: " + error.what());
  }
}

/// @throws InputError if two shards are not of one whole
void check_same(const std::string& folder, const ShardRecord& record, const std::string& other_folder,
                const ShardRecord& other) {
  const auto refuse = [&](const std::string& difference) {
    throw cases::InputError(
        fmt::format("{}: {}, and cannot be merged with {}", folder, difference, other_folder));
  };
  if (record.shard.count != other.shard.count)
    refuse(fmt::format("is one of {} shards, not {}", record.shard.count, other.shard.count));
  if (record.program != other.program) refuse("was made by another program");
  if (record.command != other.command)
    refuse(fmt::format("is of another command (springproof {})", fmt::join(record.command, " ")));
  if (record.questions != other.questions) refuse("is of other cases or settings");
}

/// What FinishedCases::keep() has left in a folder, failed solves too.
/// @throws InputError if there is nothing for this question, or it is damaged
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

} // namespace

const std::string& this_program() {
  static const std::string identity =
      program_version() + " " + program_commit() + " " +
      digest_of_files({cases::own_file(), cases::private_file("springproof_solvers.so")});
  return identity;
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

std::string digest_of(const std::vector<Question>& questions) {
  std::string identities;
  for (const Question& question : questions) identities += identity(question);
  return digest(identities);
}

std::vector<int> divide(const std::vector<double>& costs, int n_shards) {
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
  std::vector<double> load(static_cast<std::size_t>(n_shards));
  std::vector<int> shard_of(costs.size());
  for (const std::size_t piece : order) {
    const auto least = std::min_element(load.begin(), load.end());
    *least += costs[piece];
    shard_of[piece] = static_cast<int>(least - load.begin()) + 1;
  }
  return shard_of;
}

std::vector<int> divide(const std::vector<Question>& questions, int n_shards) {
  std::vector<double> costs;
  for (const Question& question : questions) costs.push_back(total_seconds(estimate(question)));
  return divide(costs, n_shards);
}

void write_record(const std::string& folder, ShardRecord record) {
  record.program = this_program();
  write_file(record_file(folder), [&](std::ostream& out) { out << text_of(record); });
}

void remove_record(const std::string& folder) {
  std::error_code absent;
  std::filesystem::remove(record_file(folder), absent);
}

Shards read_shards(const std::vector<std::string>& folders) {
  const std::string& first_folder = folders.at(0);
  const ShardRecord first = read_record(first_folder);
  if (first.program != this_program())
    throw cases::InputError(fmt::format("{}: was made by another program ({}) than this one ({})",
                                        first_folder, first.program, this_program()));
  Shards shards{first, std::vector<std::string>(static_cast<std::size_t>(first.shard.count))};
  for (const std::string& folder : folders) {
    const ShardRecord record = read_record(folder);
    check_same(folder, record, first_folder, first);
    std::string& place = shards.folders[static_cast<std::size_t>(record.shard.index - 1)];
    if (!place.empty())
      throw cases::InputError(fmt::format("{}: is shard {} of {}, and so is {}", folder, record.shard.index,
                                          record.shard.count, place));
    place = folder;
  }
  std::vector<std::size_t> missing;
  for (std::size_t s = 0; s < shards.folders.size(); ++s)
    if (shards.folders[s].empty()) missing.push_back(s + 1);
  if (!missing.empty())
    throw cases::InputError(fmt::format("merge: of {} shards {} {} missing", first.shard.count,
                                        fmt::join(missing, ", "), missing.size() == 1 ? "is" : "are"));
  return shards;
}

std::vector<Answers> answers_of(const Shards& shards, const std::vector<Question>& questions,
                                FileNames names) {
  if (digest_of(questions) != shards.record.questions)
    throw cases::InputError("merge: the cases are not what they were when the shards solved them");
  const std::vector<int> shard_of = divide(questions, static_cast<int>(shards.folders.size()));
  std::vector<Answers> answers;
  for (std::size_t q = 0; q < questions.size(); ++q)
    answers.push_back(
        kept_answers(shards.folders[static_cast<std::size_t>(shard_of[q] - 1)], questions[q], names));
  return answers;
}

} // namespace springproof::compare
