#pragma once

#include <memory>
#include <string>

namespace springproof::fem_reference {

/// MPI, PETSc and SLEPc, initialised once per process for as long as the session lives. PETSc's options come
/// from the environment variable PETSC_OPTIONS.
class Session {
 public:
  Session();

 private:
  std::shared_ptr<void> libraries_;
};

/// What is wrong with options of PETSc that come from the environment: a sentence, or nothing. Allowed are
/// those that set a solver, a preconditioner or MUMPS, and monitors and logs on standard error; not those
/// that read or write a file, start a program or load code.
/// @param options  as PETSC_OPTIONS has them, words and blanks
std::string refused_petsc_option(const std::string& options);

} // namespace springproof::fem_reference
