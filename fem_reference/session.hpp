#pragma once

#include <memory>

namespace fem_reference {

/// MPI, PETSc and SLEPc, initialised once per process for as long as the session lives. PETSc's options come
/// from the environment variable PETSC_OPTIONS; the program's own arguments are not PETSc's.
class Session {
 public:
  Session();
  ~Session();
  int rank() const;    ///< in MPI_COMM_WORLD
  int n_ranks() const; ///< of MPI_COMM_WORLD

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace fem_reference
