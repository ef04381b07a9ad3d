#include "fem_reference/session.hpp"

using namespace springproof;

namespace {

// The solves and eigenproblems of a test program need MPI, PETSc and SLEPc, which live as long as the
// process. Catch2's own main() knows nothing of them, and one of our own would compile all of Catch2 for each
// program.
const fem_reference::Session session;

} // namespace
