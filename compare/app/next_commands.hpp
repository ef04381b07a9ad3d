#pragma once

#include "compare/study/study.hpp"
#include "compare/study/verdict.hpp"

namespace springproof::compare {

/// This process's command as it was typed, quoted for a shell; empty where the system does not tell.
std::string typed_command();

/// How a case was asked for by `run`.
struct RunOfCase {
  std::string program; ///< as typed
  std::string file;
  std::vector<std::string> settings{}; ///< what --set sets
  bool has_meshes = false;             ///< --converge was given
  bool has_folder = false;             ///< --out was given
};

/// What a run leaves open: other designs, the mesh, the files.
std::vector<NextCommand> next_commands(const RunOfCase& run, const Comparison& comparison);

/// The recommended design by itself, and the files.
std::vector<NextCommand> next_commands(const RunOfCase& run, const cases::Msm& own, const Ranking& ranking);

} // namespace springproof::compare
