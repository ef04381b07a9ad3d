#pragma once

#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// Results that the ranks of MPI's world share, kept by write_kept(): one rank has one file of that name;
/// of several each has its own, NAME.1-of-4 and so on, with its share of the solutions. They are of one
/// solve or none: all name the same moment, and the first is written last. Any number of ranks takes them up.

/// Collective; what another number of ranks has left under that name is removed.
/// @throws InputError if a file cannot be written
void write_kept_parts(const std::string& path, const std::string& identity, const Answers& answers);
void write_kept_parts(const std::string& path, const std::string& identity, const Answer& answer);

/// Collective.
/// @return nothing if there is no result, or it is of another question; with a line on standard error if it
/// is damaged
std::optional<Answers> find_kept_answers(const std::string& path, const std::string& identity,
                                         const cases::HexMesh& mesh);
std::optional<Answer> find_kept_answer(const std::string& path, const std::string& identity,
                                       const cases::HexMesh& mesh);

/// The whole of it for this process alone.
/// @throws std::runtime_error if it is damaged, or there is none
Answers read_kept_answers(const std::string& path, const std::string& identity, const cases::HexMesh& mesh);

/// Removes a result, however many files it has; on rank 0.
void remove_kept_parts(const std::string& path);

} // namespace springproof::compare
