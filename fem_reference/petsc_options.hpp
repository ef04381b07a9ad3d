#pragma once

#include <string>

namespace springproof::fem_reference {

/// What is wrong with options of PETSc that come from the environment: a sentence, or nothing. Allowed are
/// those that set a solver, a preconditioner or MUMPS, and monitors and logs on standard error; not those
/// that read or write a file, start a program or load code.
/// @param options  as PETSC_OPTIONS has them, words and blanks
std::string refused_petsc_option(const std::string& options);

} // namespace springproof::fem_reference
