#pragma once

#include "compare/solve/comparison.hpp"

#include <optional>
#include <string>
#include <vector>

namespace springproof::compare {

/// What was asked of a case, besides what its file says.
struct Request {
  std::vector<std::string> settings; ///< of `--set`
  Only only = Only::both;
  int meshes = 0;   ///< of the mesh study; 0: none
  std::string peer; ///< empty: none
};

/// The cases that an earlier, interrupted command has solved, kept in DIR/solved, one file a case. One is
/// taken up again only if nothing has changed since: this very program, the text of the case file (and of its
/// mesh or surface), the request and PETSC_OPTIONS. Failed solves are not kept.
class FinishedCases {
 public:
  /// @param folder  of `--out`; empty: nothing is kept, nothing found
  explicit FinishedCases(const std::string& folder) : folder_(folder) {}

  /// The answers of an earlier command with its scene, measured anew. Collective over MPI_COMM_WORLD: rank 0
  /// reads, all get it.
  std::optional<Comparison> find(const cases::Case& definition, const Request& request) const;

  /// @throws InputError if the file cannot be written
  void keep(const Comparison& comparison, const Request& request) const;

 private:
  std::string path_of(const cases::Case& definition) const;
  std::string folder_;
};

} // namespace springproof::compare
