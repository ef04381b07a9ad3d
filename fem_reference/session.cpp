#include "fem_reference/session.hpp"

#include "cases/case/error.hpp"
#include "fem_reference/petsc_options.hpp"
#include "mechanics/petsc/handles.hpp"

#include <chrono>
#include <cstdlib>
#include <deal.II/base/mpi.h>
#include <fcntl.h>
#include <iostream>
#include <petscsys.h>
#include <thread>
#include <unistd.h>

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

/// A closed standard stream's number would be given to the next file that is opened, which would then get
/// what is printed. Instead, writing to it fails.
void reserve_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1) open("/dev/null", O_RDONLY);
}

} // namespace

Session::Session() {
  reserve_standard_streams();
  start_alone();
  unsetenv("PETSC_OPTIONS_YAML");
  const char* options = std::getenv("PETSC_OPTIONS");
  refused_option_ = refused_petsc_option(options ? options : "");
  if (!refused_option_.empty()) unsetenv("PETSC_OPTIONS");
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

void Session::check_options() const {
  if (!refused_option_.empty()) throw cases::InputError(refused_option_);
}

int Session::rank() const {
  return static_cast<int>(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
}

void Session::give_up(const std::string& message, int status) const {
  if (rank() == 0) std::cerr << message << std::endl;
  MPI_Request everyone;
  MPI_Ibarrier(MPI_COMM_WORLD, &everyone);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  int all_are_here = 0;
  while (MPI_Test(&everyone, &all_are_here, MPI_STATUS_IGNORE) == MPI_SUCCESS && !all_are_here) {
    if (std::chrono::steady_clock::now() > end) {
      if (rank() != 0) std::cerr << "rank " << rank() << ": " << message << std::endl;
      MPI_Abort(MPI_COMM_WORLD, status);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

} // namespace springproof::fem_reference
