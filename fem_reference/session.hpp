#pragma once

#include <memory>
#include <string>

namespace springproof::fem_reference {

/// MPI, PETSc and SLEPc, initialised once per process for as long as the session lives. PETSc's options come
/// from the environment variable PETSC_OPTIONS; the program's own arguments are not PETSc's.
class Session {
 public:
  Session();
  int rank() const; ///< in MPI_COMM_WORLD

  /// @throws cases::InputError if PETSC_OPTIONS has one that is not allowed; then PETSc has got none of them
  void check_options() const;

  /// For a rank that meets an error. Rank 0 tells it. Returns when all ranks meet one; when some do not
  /// within two seconds, ends them all with this status, because they may be waiting for this rank for ever.
  void give_up(const std::string& message, int status) const;

 private:
  std::shared_ptr<void> libraries_;
  std::string refused_option_;
};

} // namespace springproof::fem_reference
