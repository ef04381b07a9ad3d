#include "compare/solve/solvers.hpp"

#include <cstdlib>

using namespace springproof;

namespace {

/// Starts MPI before the first test where a launcher started the ranks. Alone, the first solve that needs it starts it.
const compare::SolverFunctions* started = std::getenv("OMPI_COMM_WORLD_SIZE") ? &compare::solvers() : nullptr;

} // namespace
