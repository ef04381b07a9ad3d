#include "compare/app/session.hpp"

#include "cases/case/error.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/solve/solvers.hpp"

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <iostream>
#include <mpi.h>
#include <thread>
#include <unistd.h>

namespace springproof::compare {

void reserve_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1) open("/dev/null", O_RDONLY);
  std::signal(SIGXFSZ, SIG_IGN); // writing beyond a limit (ulimit -f) fails with a reason
}

void start_ranks() {
  if (is_under_mpi_launcher()) solvers();
}

void give_up(const std::string& message, int status) {
  const int rank = mpi_rank();
  if (rank == 0) std::cerr << message << std::endl;
  if (n_mpi_ranks() == 1) return;
  MPI_Request everyone;
  MPI_Ibarrier(MPI_COMM_WORLD, &everyone);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  int all_are_here = 0;
  while (MPI_Test(&everyone, &all_are_here, MPI_STATUS_IGNORE) == MPI_SUCCESS && !all_are_here) {
    if (std::chrono::steady_clock::now() > end) {
      if (rank != 0) std::cerr << "rank " << rank << ": " << message << std::endl;
      MPI_Abort(MPI_COMM_WORLD, status);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

} // namespace springproof::compare
