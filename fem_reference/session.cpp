#include "fem_reference/session.hpp"

#include <deal.II/base/mpi.h>

namespace fem_reference {

struct Session::Implementation {
  int argc = 1;
  char name[12] = "springproof";
  char* arguments[2] = {name, nullptr};
  char** argv = arguments;
  dealii::Utilities::MPI::MPI_InitFinalize mpi{argc, argv,
                                               1}; // one thread a rank: cases and ranks share the cores
};

Session::Session() : implementation_(std::make_unique<Implementation>()) {}
Session::~Session() = default;

int Session::rank() const {
  return static_cast<int>(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
}
int Session::n_ranks() const {
  return static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
}

} // namespace fem_reference
