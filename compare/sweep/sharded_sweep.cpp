#include "compare/sweep/sharded_sweep.hpp"

#include "cases/case/error.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/kept.hpp"
#include "compare/sweep/costs.hpp"

#include <fmt/format.h>
#include <iostream>
#include <mpi.h>

namespace springproof::compare {

namespace {

std::string identity_of_run(const Sweep& sweep, const Variant& variant) {
  return identity_of(fmt::format("{} ranks, {} ", sweep.n_ranks, static_cast<int>(sweep.processes)) +
                     timing_job(sweep.definition, variant, sweep.rules));
}

std::string digest_of(const Sweep& sweep) {
  std::string identities;
  for (const Variant& variant : sweep.plan.variants) identities += identity_of_run(sweep, variant);
  return digest(identities);
}

std::string path_of(const std::string& folder, const Variant& variant) {
  return folder + "/solved/" + full_name(variant);
}

bool has_failed(const VariantRun& run) {
  return run.first.status == cases::Status::failed;
}

/// What an earlier command has kept, if it did not fail.
std::optional<VariantRun> find_run(const std::string& path, const std::string& identity,
                                   const Variant& variant) {
  try {
    const std::string bytes = read_kept(path, identity);
    if (bytes.empty()) return std::nullopt;
    VariantRun run = variant_run_from(bytes, variant);
    if (has_failed(run)) return std::nullopt;
    return run;
  } catch (const std::exception& error) {
    print(std::cerr, "{}: {}; the variant is timed again\n", path, error.what());
    return std::nullopt;
  }
}

VariantRun kept_run(const std::string& path, const std::string& identity, const Variant& variant) {
  try {
    const std::string bytes = read_kept(path, identity);
    if (bytes.empty()) throw std::runtime_error("has no timing");
    return variant_run_from(bytes, variant);
  } catch (const std::exception& error) {
    throw cases::InputError(path + ": " + error.what());
  }
}

/// All ranks go by what rank 0 found.
bool on_rank_0(bool is_kept) {
  int kept = is_kept ? 1 : 0;
  if (n_mpi_ranks() > 1) MPI_Bcast(&kept, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return kept == 1;
}

} // namespace

TimedPart time_shard(const Sweep& sweep, const Shard& shard, const std::string& folder,
                     const std::vector<std::string>& command, const std::string& program) {
  claim_subfolder(folder, "solved");
  if (mpi_rank() == 0) remove_record(folder);
  const Stopwatch stopwatch;
  const std::vector<double> seconds = estimated_seconds(sweep);
  const std::vector<int> shard_of = divide(seconds, shard.count);
  ProgressLine line(1);
  for (std::size_t v = 0; v < shard_of.size(); ++v)
    if (shard_of[v] == shard.index) line.expect({1, seconds[v]});
  TimedPart part;
  for (std::size_t v = 0; v < shard_of.size(); ++v) {
    if (shard_of[v] != shard.index) continue;
    const Variant& variant = sweep.plan.variants[v];
    const std::string path = path_of(folder, variant), identity = identity_of_run(sweep, variant);
    std::optional<VariantRun> run;
    if (mpi_rank() == 0) run = find_run(path, identity, variant);
    if (!on_rank_0(run.has_value())) {
      run = run_variant(sweep, variant, program, line);
      if (mpi_rank() == 0) write_kept(path, identity, bytes_of(*run));
    } else {
      line.skip(seconds[v]);
    }
    ++part.n_variants;
    if (mpi_rank() == 0 && has_failed(*run)) ++part.n_failed;
  }
  if (mpi_rank() == 0) write_record(folder, {shard, command, digest_of(sweep), stopwatch.seconds()});
  return part;
}

Sweep merged_sweep(Sweep sweep, const Shards& shards) {
  for (std::size_t s = 0; s < shards.records.size(); ++s) {
    if (shards.records[s].processor != shards.records[0].processor)
      throw cases::InputError(fmt::format("{}: was timed on {}, {} on {}: such times cannot be compared",
                                          shards.folders[s], shards.records[s].processor, shards.folders[0],
                                          shards.records[0].processor));
    sweep.seconds += shards.records[s].seconds;
  }
  check_questions(shards, digest_of(sweep));
  const std::vector<int> shard_of = divide(estimated_seconds(sweep), static_cast<int>(shards.folders.size()));
  for (std::size_t v = 0; v < shard_of.size(); ++v) {
    const Variant& variant = sweep.plan.variants[v];
    const std::string& folder = shards.folders[static_cast<std::size_t>(shard_of[v] - 1)];
    add_row(sweep, variant, kept_run(path_of(folder, variant), identity_of_run(sweep, variant), variant));
  }
  return sweep;
}

} // namespace springproof::compare
