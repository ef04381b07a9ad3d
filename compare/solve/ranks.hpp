#pragma once

#include "compare/solve/answers.hpp"

#include <functional>

/// What the ranks of MPI's world do together. Every function is collective, and works on one rank too.
namespace springproof::compare {

/// Rank 0's text on every rank.
std::string from_rank_0(std::string text);

/// Whether this holds on all ranks.
bool on_all_ranks(bool here);

/// Runs what may fail on one rank alone, such as writing a file.
/// @throws InputError on every rank, with the reason of the first that it failed on
void run_on_all_ranks(const std::function<void()>& action);

/// @param bytes  those of this rank's cases   @throws InputError on every rank unless all have the same
void check_same_on_ranks(const std::string& bytes);

/// An Answer, or Answers, that rank 0 alone finds, shared by all ranks.
/// @param find  called on rank 0   @throws InputError that it throws, on every rank
template<class Result>
Result shared_from_rank_0(const cases::Mesh& mesh, const std::function<Result()>& find);

/// The solution with all of its values on every rank.
cases::Solution gathered(cases::Solution solution);
Answer gathered(Answer answer);
Answers gathered(Answers answers);

} // namespace springproof::compare
