#include "compare/provenance/mpi_rank.hpp"

#include <mpi.h>

namespace springproof::compare {

int mpi_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

} // namespace springproof::compare
