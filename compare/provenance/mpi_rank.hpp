#pragma once

#include <mpi.h>

namespace springproof::compare {

/// This process's number in MPI's world; 0 for a process alone. MPI must have been started.
inline int mpi_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

} // namespace springproof::compare
