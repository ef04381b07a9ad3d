#pragma once

namespace springproof::compare {

/// This process's number in MPI's world; 0 for a process alone. MPI must have been started.
int mpi_rank();

} // namespace springproof::compare
