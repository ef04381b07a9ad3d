#pragma once

#include "compare/solve/shard.hpp"
#include "compare/sweep/sweep.hpp"

/// A sweep divided among several machines: each times some of the variants and keeps what it measured in
/// DIR/solved. Errors are found when all are merged: one shard alone has not the whole reference.
namespace springproof::compare {

/// How many variants a shard had, and how many of them failed.
struct TimedPart {
  std::size_t n_variants = 0, n_failed = 0;
};

/// Times the variants of a shard, keeps each as soon as it is timed, and leaves the shard's record. What an
/// earlier, interrupted command has timed in the same folder is taken up. Collective over MPI_COMM_WORLD.
/// @param sweep    without rows   @param command  for the record
/// @param program  whose hidden command `worker` serves
/// @throws InputError if the folder cannot be written
TimedPart time_shard(const Sweep& sweep, const Shard& shard, const std::string& folder,
                     const std::vector<std::string>& command, const std::string& program);

/// The sweep with the rows that its shards timed. Its seconds are the sum of theirs.
/// @throws InputError if a run is missing or damaged, the case is another, or processors differ, whose times
/// say nothing about each other
Sweep merged_sweep(Sweep sweep, const Shards& shards);

} // namespace springproof::compare
