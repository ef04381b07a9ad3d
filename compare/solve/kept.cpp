#include "compare/solve/kept.hpp"

#include "cases/case/input_file.hpp"
#include "compare/solve/fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <openssl/evp.h>
#include <openssl/sha.h>
#include <stdexcept>

namespace springproof::compare {

namespace {

/// First line of a kept file. Counted up when the fields of compare/solve/fields.hpp change their meaning.
const std::string heading = "springproof answers, format 6\n";

bool is_finite(double value) {
  return std::isfinite(value);
}

/// Whether all numbers of vectors or tensors are finite, or all of a list.
template<class Values>
bool is_finite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](const auto& value) { return is_finite(value); });
}

/// Whether fields, if any, have as many finite values as the mesh has nodes and cells.
bool fit(const std::optional<cases::Fields>& fields, const cases::Mesh& mesh) {
  if (!fields) return true;
  const auto& [reaction, total_energy, has_stress, energy, stress, strain] = *fields;
  const std::size_t n_of_stress = has_stress ? mesh.cells.size() : 0;
  return reaction.size() == mesh.nodes.size() && energy.size() == n_of_stress &&
         stress.size() == n_of_stress && strain.size() == mesh.cells.size() && is_finite(total_energy) &&
         is_finite(reaction) && is_finite(energy) && is_finite(stress) && is_finite(strain);
}

/// Whether a motion is one of a body with that many nodes at least, and with so many tools.
bool is_sound(const cases::Trajectory& motion, std::size_t n_nodes, std::size_t n_tools) {
  const std::size_t n = motion.time.size();
  const auto is_node = [&](int node) { return node >= 0 && cases::index(node) < n_nodes; };
  const auto is_body = [&](const cases::Trajectory::Body& body) {
    return body.step >= 0 && cases::index(body.step) < n && body.displacement.size() >= n_nodes &&
           is_finite(body.displacement);
  };
  return n > 0 && motion.displacement.size() == n * motion.nodes.size() &&
         (motion.volume.empty() || motion.volume.size() == n) && motion.tools.size() == n * n_tools &&
         (!motion.slowest || (motion.slowest->omega > 0 && std::isfinite(motion.slowest->omega) &&
                              std::isfinite(motion.slowest->damping_ratio))) &&
         std::is_sorted(motion.time.begin(), motion.time.end()) &&
         std::is_sorted(motion.nodes.begin(), motion.nodes.end()) && is_finite(motion.time) &&
         is_finite(motion.displacement) && is_finite(motion.volume) &&
         std::all_of(motion.nodes.begin(), motion.nodes.end(), is_node) &&
         std::all_of(motion.bodies.begin(), motion.bodies.end(), is_body);
}

/// @throws std::runtime_error if a solution has not as many values as the mesh has nodes and cells
void check(const cases::Solution& solution, const cases::Mesh& mesh) {
  const auto is_empty_or = [&](std::size_t size, std::size_t expected) {
    return size == expected || (size == 0 && solution.status != cases::Status::converged);
  };
  const bool has_numbers = is_finite(solution.displacement) && is_finite(solution.cell_volume);
  const bool is_moved =
      !solution.trajectory || is_sound(*solution.trajectory, mesh.nodes.size(), solution.tools.size());
  if (!fit(solution.fields, mesh))
    throw std::runtime_error("has fields that are not those of the case's mesh");
  if (!is_empty_or(solution.displacement.size(), mesh.nodes.size()) ||
      !is_empty_or(solution.cell_volume.size(), mesh.cells.size()) || !has_numbers || !is_moved)
    throw std::runtime_error("has values that are no solution on the case's mesh");
}

void check_meshes(const Answer&) {}
void check_meshes(const Answers& answers) {
  if (answers.refined && answers.refined->solutions.size() != answers.refined->refine.size())
    throw std::runtime_error("has not as many refined solutions as meshes");
}

constexpr int most_shards = 10'000;

bool exists(const Shard& shard) {
  return 1 <= shard.index && shard.index <= shard.count && shard.count <= most_shards;
}

/// SHA-256 of a file, read in pieces: a library as one text takes four times as long.
/// @return "none" if there is no file that can be read
std::string digest_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return "none";
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  std::vector<char> piece(1 << 16);
  std::array<unsigned char, SHA256_DIGEST_LENGTH> sum{};
  bool is_good = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  while (is_good && in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    is_good = EVP_DigestUpdate(context.get(), piece.data(), static_cast<std::size_t>(in.gcount())) == 1;
  }
  is_good = is_good && !in.bad() && EVP_DigestFinal_ex(context.get(), sum.data(), nullptr) == 1;
  if (!is_good) throw std::runtime_error(path + ": cannot be digested");
  return fmt::format("{:02x}", fmt::join(sum, ""));
}

/// 0, which no shard has, for anything else than a number that one may have.
int shard_number(const nlohmann::json& value) {
  return value.is_number_integer() && 1 <= value && value <= most_shards ? value.get<int>() : 0;
}

} // namespace

std::string digest(const std::string& bytes) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> sum;
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), sum.data());
  return fmt::format("{:02x}", fmt::join(sum, ""));
}

std::string digest_of_files(const std::vector<std::string>& paths) {
  std::string digests;
  for (const std::string& path : paths) digests += digest_of_file(path) + ' ';
  return digest(digests);
}

std::string kept_text(const std::string& identity, const std::string& result) {
  const std::string sum = digest(identity + ' ' + result);
  return fmt::format("{}{} {} {}\n", heading, identity, result.size(), sum) + result;
}

std::string result_in(const std::string& text, const std::string& identity) {
  if (text.compare(0, heading.size(), heading) != 0)
    throw std::runtime_error("has another format than this program's");
  const std::size_t begin = heading.size(), end = text.find('\n', begin);
  const std::string of = text.substr(begin, text.find(' ', begin) - begin);
  const std::string result = end == std::string::npos ? "" : text.substr(end + 1);
  if (text != kept_text(of, result)) throw std::runtime_error("is damaged");
  return of == identity ? result : "";
}

template<class Result>
Result result_from(const std::string& bytes, const cases::Mesh& mesh) {
  Result result;
  cases::from_bytes(bytes, result);
  check_meshes(result);
  for (const cases::Solution* solution : solutions_of(result)) check(*solution, mesh);
  return result;
}
template Answer result_from(const std::string&, const cases::Mesh&);
template Answers result_from(const std::string&, const cases::Mesh&);

std::optional<Shard> shard_from(const std::string& text) {
  const std::size_t stroke = std::min(text.find('/'), text.size());
  const std::string_view all = text;
  const auto index = cases::number_in<int>(all.substr(0, stroke)),
             count = cases::number_in<int>(all.substr(std::min(stroke + 1, all.size())));
  if (!index || !count) return std::nullopt;
  const Shard shard{*index, *count};
  return exists(shard) ? std::optional(shard) : std::nullopt;
}

std::string text_of(const ShardRecord& record) {
  const nlohmann::ordered_json json{{"shard", record.shard.index},
                                    {"of", record.shard.count},
                                    {"command", record.command},
                                    {"questions", record.questions},
                                    {"program", record.program}};
  return json.dump(2) + '\n';
}

ShardRecord record_from(const std::string& text) {
  const auto json = nlohmann::json::parse(text);
  const ShardRecord record{{shard_number(json.at("shard")), shard_number(json.at("of"))},
                           json.at("command"),
                           json.at("questions"),
                           json.at("program")};
  if (!exists(record.shard))
    throw std::runtime_error(
        fmt::format("there is no shard {} of {}", record.shard.index, record.shard.count));
  return record;
}

} // namespace springproof::compare
