#pragma once

#include "compare/solve/answers.hpp"

#include <optional>
#include <string>
#include <vector>

namespace springproof::compare {

/// The cases that an earlier, interrupted command has solved, kept in DIR/solved, one file a case. One is
/// taken up again only if nothing has changed since: this very program, the text of the case file (and of its
/// mesh or surface), the request and PETSC_OPTIONS. Failed solves are not kept.
class FinishedCases {
 public:
  /// @param folder  of `--out`; empty: nothing is kept, nothing found
  explicit FinishedCases(const std::string& folder) : folder_(folder) {}

  /// The answers of an earlier command. Collective over MPI_COMM_WORLD: rank 0 reads, all get them.
  std::optional<Answers> find(const cases::Case& definition, const Request& request) const;

  /// @throws InputError if the file cannot be written
  void keep(const cases::Case& definition, const Request& request, const Answers& answers) const;

 private:
  std::string path_of(const cases::Case& definition) const;
  std::string folder_;
};

} // namespace springproof::compare
