#include "compare/solve/solvers.hpp"

using namespace springproof;

namespace {

// Tests of several ranks need MPI from the start.
const compare::SolverFunctions& started = compare::solvers();

} // namespace
