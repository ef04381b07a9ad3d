#include "fem_reference/session.hpp"

#include "mechanics/petsc/handles.hpp"

#include <cstdlib>
#include <deal.II/base/mpi.h>
#include <petscsys.h>

namespace springproof::fem_reference {

namespace {

/// A process that no launcher started has nobody to talk to, but Open MPI would start its daemon for it and
/// look for networks: half a second. It would also make a folder that all of a user's processes share, which
/// one that ends can remove under one that starts. What the user has set stays.
void start_alone() {
  for (const char* launched : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (std::getenv(launched)) return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
}

} // namespace

Session::Session() {
  start_alone();
  // The working folder may be a stranger's: its .petscrc is not read. Signals keep their default actions.
  static char name[] = "springproof", no_options_file[] = "-skip_petscrc",
              no_signal_handler[] = "-no_signal_handler";
  static char* arguments[] = {name, no_options_file, no_signal_handler, nullptr};
  static char** argv = arguments; // PETSc keeps them
  static int argc = 3;
  // one thread a rank: cases and ranks share the cores
  libraries_ = std::make_shared<dealii::Utilities::MPI::MPI_InitFinalize>(argc, argv, 1);
  PETSC_STDOUT = stderr; // standard output is the results' alone
  mechanics::petsc::keep_quiet();
}

} // namespace springproof::fem_reference
