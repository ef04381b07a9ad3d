#include "compare/solve/ranks.hpp"

#include "cases/case/error.hpp"
#include "cases/mesh/sharing.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/fields.hpp"
#include "mechanics/ranks/share_out.hpp"

#include <fmt/format.h>
#include <mpi.h>
#include <new>

namespace springproof::compare {

namespace {

/// Text of a rank on every rank.
std::string from_rank(int rank, std::string text) {
  unsigned long size = text.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, rank, MPI_COMM_WORLD);
  text.resize(size);
  constexpr unsigned long most = 1ul << 30; // MPI counts in int
  for (unsigned long at = 0; at < size; at += most)
    MPI_Bcast(text.data() + at, static_cast<int>(std::min(most, size - at)), MPI_CHAR, rank, MPI_COMM_WORLD);
  return text;
}

template<class Value>
std::vector<cases::Numbered<Value>> numbered(const std::vector<Value>& values) {
  std::vector<cases::Numbered<Value>> all;
  for (std::size_t i = 0; i < values.size(); ++i) all.push_back({static_cast<std::int64_t>(i), values[i]});
  return all;
}

/// Takes the values of nodes and cells out of a solution.  @return what it was
cases::Solution without_values(cases::Solution& solution) {
  cases::Solution whole = solution;
  solution.displacement.clear();
  solution.cell_volume.clear();
  if (auto& fields = solution.fields)
    fields = cases::Fields{{}, fields->total_energy, fields->has_stress, {}, {}, {}};
  return whole;
}

/// Gives every rank its share of the values.
/// @param whole  rank 0's; nothing on the others   @param here  has no values before
void deal_out(const cases::Solution& whole, const cases::Mesh& mesh, cases::Solution& here) {
  here.sharing = mechanics::share_out(mesh, MPI_COMM_WORLD);
  const cases::Sharing& sharing = *here.sharing;
  here.displacement = sharing.deal(numbered(whole.displacement));
  here.cell_volume = sharing.deal(numbered(whole.cell_volume));
  if (!here.fields) return;
  const cases::Fields all = whole.fields.value_or(cases::Fields{});
  here.fields->reaction = sharing.deal(numbered(all.reaction));
  here.fields->strain = cases::deal(sharing, numbered(all.strain));
  if (!here.fields->has_stress) return;
  here.fields->strain_energy = sharing.deal(numbered(all.strain_energy));
  here.fields->stress = cases::deal(sharing, numbered(all.stress));
}

cases::Fields fields_of_all(cases::Fields fields, const cases::Sharing& sharing) {
  fields.reaction = sharing.gather(fields.reaction);
  fields.strain = cases::gather(sharing, fields.strain);
  if (!fields.has_stress) return fields;
  fields.strain_energy = sharing.gather(fields.strain_energy);
  fields.stress = cases::gather(sharing, fields.stress);
  return fields;
}

} // namespace

std::string from_rank_0(std::string text) {
  return n_mpi_ranks() == 1 ? text : from_rank(0, std::move(text));
}

bool on_all_ranks(bool here) {
  if (n_mpi_ranks() == 1) return here;
  int all = here ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return all == 1;
}

void run_on_all_ranks(const std::function<void()>& action) {
  if (n_mpi_ranks() == 1) return action();
  std::string reason;
  int failed = n_mpi_ranks(); // the first rank that did
  try {
    action();
  } catch (const std::exception& error) {
    reason = dynamic_cast<const std::bad_alloc*>(&error) ? "springproof: not enough memory" : error.what();
    failed = mpi_rank();
  }
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (failed < n_mpi_ranks()) throw cases::InputError(from_rank(failed, reason));
}

void check_same_on_ranks(const std::string& bytes) {
  const std::string expected = from_rank_0(bytes);
  run_on_all_ranks([&] {
    if (bytes != expected)
      throw cases::InputError(fmt::format("rank {} was given other cases than rank 0: all need the same "
                                          "command, and the same files",
                                          mpi_rank()));
  });
}

template<class Result>
Result shared_from_rank_0(const cases::Mesh& mesh, const std::function<Result()>& find) {
  if (n_mpi_ranks() == 1) return find();
  Result result;
  std::vector<cases::Solution> whole; // on rank 0
  run_on_all_ranks([&] {
    if (mpi_rank() != 0) return;
    result = find();
    for (cases::Solution* solution : solutions_of(result)) whole.push_back(without_values(*solution));
  });
  cases::from_bytes(from_rank_0(mpi_rank() == 0 ? cases::to_bytes(result) : ""), result);
  whole.resize(solutions_of(result).size());
  for (std::size_t s = 0; s < whole.size(); ++s)
    if (cases::Solution& solution = *solutions_of(result)[s]; solution.status == cases::Status::converged)
      deal_out(whole[s], mesh, solution);
  return result;
}
template Answer shared_from_rank_0(const cases::Mesh&, const std::function<Answer()>&);
template Answers shared_from_rank_0(const cases::Mesh&, const std::function<Answers()>&);

cases::Solution gathered(cases::Solution solution) {
  if (!solution.sharing) return solution;
  solution.displacement = solution.sharing->gather(solution.displacement);
  solution.cell_volume = solution.sharing->gather(solution.cell_volume);
  if (solution.fields) solution.fields = fields_of_all(std::move(*solution.fields), *solution.sharing);
  solution.sharing.reset();
  return solution;
}

Answer gathered(Answer answer) {
  answer.solution = gathered(std::move(answer.solution));
  return answer;
}

Answers gathered(Answers answers) {
  for (cases::Solution* solution : solutions_of(answers)) *solution = gathered(std::move(*solution));
  return answers;
}

} // namespace springproof::compare
