#include "compare/solve/solvers.hpp"

#include "cases/case/error.hpp"
#include "cases/case/installation.hpp"
#include "compare/provenance/machine.hpp"
#include "fem_reference/session.hpp"

#include <cstdlib>

namespace springproof::compare {

namespace {

/// What is wrong with PETSC_OPTIONS, which are then taken out of the environment.
const std::string& refused_petsc_options() {
  static const std::string refused = [] {
    unsetenv("PETSC_OPTIONS_YAML");
    const char* const options = std::getenv("PETSC_OPTIONS");
    std::string reason = fem_reference::refused_petsc_option(options ? options : "");
    if (!reason.empty()) unsetenv("PETSC_OPTIONS");
    return reason;
  }();
  return refused;
}

struct Started {
  const SolverFunctions& functions;
  std::shared_ptr<void> libraries;
};

/// Starts without options that are not allowed: ranks must start before one can say what is wrong with them.
Started start() {
  constexpr double megabytes = 750; // 690 are taken until the first solve
  if (const std::string reason = why_not_to_start(megabytes); !reason.empty())
    throw cases::InputError("springproof: " + reason);
  refused_petsc_options();
  const auto& functions =
      *static_cast<const SolverFunctions*>(cases::load_shared_object("springproof_solvers"));
  return {functions, functions.start()};
}

} // namespace

const SolverFunctions& solvers() {
  static const Started started = start(); // destroyed before what the libraries themselves hold
  check_petsc_options();
  return started.functions;
}

void check_petsc_options() {
  if (!refused_petsc_options().empty()) throw cases::InputError(refused_petsc_options());
}

} // namespace springproof::compare
