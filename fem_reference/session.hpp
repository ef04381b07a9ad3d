#pragma once

#include <memory>

namespace springproof::fem_reference {

/// MPI, PETSc and SLEPc, initialised once per process for as long as the session lives. PETSc's options come
/// from the environment variable PETSC_OPTIONS.
class Session {
 public:
  Session();

 private:
  std::shared_ptr<void> libraries_;
};

} // namespace springproof::fem_reference
