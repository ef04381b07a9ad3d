#include "compare/solve/kept_parts.hpp"

#include "cases/mesh/sharing.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/solve/answer_bytes.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/frame.hpp"
#include "compare/solve/kept.hpp"
#include "compare/solve/ranks.hpp"
#include "mechanics/ranks/share_out.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>

namespace springproof::compare {

namespace {

namespace fs = std::filesystem;
using cases::index;
using cases::Range;
using cases::Share;

/// Of so many parts one, counted from 0.
struct Part {
  int number = 0, count = 1;
};

std::string path_of(const std::string& path, const Part& part) {
  return part.count == 1 ? path : fmt::format("{}.{}-of-{}", path, part.number + 1, part.count);
}
std::string identity_of(const std::string& identity, const Part& part) {
  return part.count == 1 ? identity : digest(fmt::format("{} {} of {}", identity, part.number, part.count));
}

/// The file's part, if it is one of a result with that path.
std::optional<Part> part_in(const std::string& path, const fs::path& file) {
  if (file.filename() == fs::path(path).filename()) return Part{};
  const std::string name = file.filename().string(), begin = fs::path(path).filename().string() + ".";
  const std::size_t middle = name.rfind("-of-");
  if (name.compare(0, begin.size(), begin) != 0 || middle == std::string::npos) return std::nullopt;
  const auto number = [](const std::string& digits) {
    const bool is_one =
        !digits.empty() && digits.size() < 9 && digits.find_first_not_of("0123456789") == std::string::npos;
    return is_one ? std::stoi(digits) : 0;
  };
  const Part part{number(name.substr(begin.size(), std::max(middle, begin.size()) - begin.size())) - 1,
                  number(name.substr(middle + 4))};
  return part.number >= 0 && part.number < part.count ? std::optional(part) : std::nullopt;
}

/// The parts of a result that are there.
std::vector<Part> parts_of(const std::string& path) {
  std::vector<Part> parts;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path(), none))
    if (const auto part = part_in(path, entry.path())) parts.push_back(*part);
  return parts;
}

/// In how many parts a result may be there: what this number of ranks has left first.
std::vector<int> counts_of(const std::string& path, int n_ranks) {
  std::vector<int> counts;
  for (const Part& part : parts_of(path))
    if (part.number == 0) counts.push_back(part.count);
  std::sort(counts.begin(), counts.end(),
            [&](int a, int b) { return std::pair(a != n_ranks, a) < std::pair(b != n_ranks, b); });
  return counts;
}

Answers result_from(const std::string& bytes, const Share& share, const Answers*) {
  return answers_from(bytes, share);
}
Answer result_from(const std::string& bytes, const Share& share, const Answer*) {
  return answer_from(bytes, share);
}
std::vector<cases::Solution*> solutions_of(Answer& answer) {
  return {&answer.solution};
}

constexpr std::size_t moment_size = 32;

template<class Result>
struct Read {
  std::string moment; ///< that names the solve; empty: there is but one part
  Result result;
};

/// @throws std::runtime_error if it is damaged
template<class Result>
std::optional<Read<Result>> read_part(const std::string& path, const std::string& identity,
                                      const cases::HexMesh& mesh, const Part& part) {
  std::string bytes = read_kept(path_of(path, part), identity_of(identity, part));
  if (bytes.empty()) return std::nullopt;
  const std::size_t n = part.count == 1 ? 0 : std::min(moment_size, bytes.size());
  const std::string moment = bytes.substr(0, n);
  bytes.erase(0, n);
  const Share share = cases::share_of(mesh, part.number, part.count);
  return Read<Result>{moment, result_from(bytes, share, static_cast<const Result*>(nullptr))};
}

template<class Value>
void take(const std::vector<Value>& from, const Range& of, std::vector<Value>& to, const Range& here) {
  const Range both = of.common(here);
  for (std::size_t i = both.begin; i < both.end; ++i) to[i - here.begin] = from[i - of.begin];
}

/// Takes what a share and the wanted one have in common.
/// @param is_first  what is in `to` is of another share, and is replaced
/// @return whether both have the same kinds of values
bool take(const cases::Solution& from, const Share& of, cases::Solution& to, const Share& wanted,
          bool is_first) {
  const auto take_values = [&](const auto& values, Range Share::*part, auto& into) {
    if (is_first) {
      into.clear();
      into.resize((wanted.*part).size());
    }
    take(values, of.*part, into, wanted.*part);
  };
  if (to.displacement.empty() != from.displacement.empty() ||
      to.fields.has_value() != from.fields.has_value())
    return false;
  if (from.displacement.empty()) return true;
  take_values(from.displacement, &Share::nodes, to.displacement);
  take_values(from.cell_volume, &Share::cells, to.cell_volume);
  if (!from.fields) return true;
  if (to.fields->has_stress != from.fields->has_stress) return false;
  take_values(from.fields->reaction, &Share::nodes, to.fields->reaction);
  take_values(from.fields->strain, &Share::cells, to.fields->strain);
  if (!from.fields->has_stress) return true;
  take_values(from.fields->strain_energy, &Share::cells, to.fields->strain_energy);
  take_values(from.fields->stress, &Share::cells, to.fields->stress);
  return true;
}

/// A share of a result that is there in so many parts.  @throws std::runtime_error if it is damaged
template<class Result>
std::optional<Read<Result>> read_parts(const std::string& path, const std::string& identity,
                                       const cases::HexMesh& mesh, int count, const Part& here) {
  if (count == here.count) return read_part<Result>(path, identity, mesh, here);
  const Share wanted = cases::share_of(mesh, here.number, here.count);
  std::optional<Read<Result>> found;
  for (int number = 0; number < count; ++number) {
    const Share share = cases::share_of(mesh, number, count);
    const bool is_needed =
        share.nodes.common(wanted.nodes).size() + share.cells.common(wanted.cells).size() > 0;
    if (number > 0 && !is_needed) continue;
    std::optional<Read<Result>> part = read_part<Result>(path, identity, mesh, {number, count});
    if (!part || (found && part->moment != found->moment)) return std::nullopt;
    if (!found) found = *part; // with the values of its share, which are replaced below
    const auto from = solutions_of(part->result), to = solutions_of(found->result);
    if (from.size() != to.size()) return std::nullopt;
    for (std::size_t s = 0; s < to.size(); ++s)
      if (!take(*from[s], share, *to[s], wanted, number == 0)) return std::nullopt;
  }
  return found;
}

std::string joined(const std::vector<int>& numbers) {
  return fmt::format("{}", fmt::join(numbers, " "));
}
std::vector<int> split(const std::string& text) {
  std::vector<int> numbers;
  std::istringstream words(text);
  for (int number = 0; words >> number;) numbers.push_back(number);
  return numbers;
}

template<class Result>
std::optional<Result> find_kept(const std::string& path, const std::string& identity,
                                const cases::HexMesh& mesh) {
  const Part here{mpi_rank(), n_mpi_ranks()};
  for (const int count : split(from_rank_0(mpi_rank() == 0 ? joined(counts_of(path, here.count)) : ""))) {
    std::optional<Read<Result>> found;
    try {
      found = read_parts<Result>(path, identity, mesh, count, here);
    } catch (const std::exception& error) {
      print(std::cerr, "{}: {}; the case is solved again\n", path, error.what());
    }
    if (here.count > 1) {
      const bool is_one = on_all_ranks(found.has_value());
      const std::string moment = from_rank_0(found ? found->moment : "");
      if (!is_one || !on_all_ranks(found->moment == moment)) continue;
      for (cases::Solution* solution : solutions_of(found->result))
        if (!solution->displacement.empty() || solution->status == cases::Status::converged)
          solution->sharing = mechanics::share_out(mesh, MPI_COMM_WORLD);
    }
    if (found) return std::move(found->result);
  }
  return std::nullopt;
}

template<class Result>
void write_parts(const std::string& path, const std::string& identity, const Result& result) {
  const Part part{mpi_rank(), n_mpi_ranks()};
  std::string moment;
  if (part.count > 1) {
    const auto now = std::chrono::system_clock::now().time_since_epoch().count();
    moment = from_rank_0(digest(fmt::format("{} {}", now, identity))).substr(0, moment_size);
  }
  const auto write = [&] {
    write_kept(path_of(path, part), identity_of(identity, part), moment + cases::to_bytes(result));
  };
  if (part.count > 1)
    run_on_all_ranks([&] {
      if (part.number != 0) write();
    });
  run_on_all_ranks([&] {
    if (part.number != 0) return;
    write();
    std::error_code not_there;
    for (const Part& left : parts_of(path))
      if (left.count != part.count) fs::remove(path_of(path, left), not_there);
  });
}

} // namespace

void write_kept_parts(const std::string& path, const std::string& identity, const Answers& answers) {
  write_parts(path, identity, answers);
}
void write_kept_parts(const std::string& path, const std::string& identity, const Answer& answer) {
  write_parts(path, identity, answer);
}

std::optional<Answers> find_kept_answers(const std::string& path, const std::string& identity,
                                         const cases::HexMesh& mesh) {
  return find_kept<Answers>(path, identity, mesh);
}
std::optional<Answer> find_kept_answer(const std::string& path, const std::string& identity,
                                       const cases::HexMesh& mesh) {
  return find_kept<Answer>(path, identity, mesh);
}

Answers read_kept_answers(const std::string& path, const std::string& identity, const cases::HexMesh& mesh) {
  for (const int count : counts_of(path, 1))
    if (auto found = read_parts<Answers>(path, identity, mesh, count, {})) return std::move(found->result);
  throw std::runtime_error("has no answers to the case as it is now");
}

void remove_kept_parts(const std::string& path) {
  if (mpi_rank() != 0) return;
  std::error_code not_there;
  for (const Part& part : parts_of(path)) fs::remove(path_of(path, part), not_there);
}

} // namespace springproof::compare
