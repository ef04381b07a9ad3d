#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace springproof::compare {

std::string program_version();
/// Short hash, with "-dirty" for uncommitted changes; "unknown" outside a checkout.
std::string program_commit();

/// Folder of the case files and data that come with the program; the environment variable SPRINGPROOF_CASES
/// moves it.
std::string cases_folder();

/// This process's number in MPI's world; 0 for a process alone, which need not have started MPI.
int mpi_rank();
int n_mpi_ranks(); ///< size of MPI's world; 1 for a process alone
/// Number of MPI's ranks on this machine, as the launcher tells; all ranks, if it does not.
int n_mpi_ranks_here();

/// The machine and build that a timing depends on.
struct Machine {
  std::string processor;
  int cores;
  std::string system;   ///< "Linux 6.1 x86_64"
  std::string compiler; ///< that built this program
  std::string blas;     ///< OpenBLAS' own description, or "not OpenBLAS"
};

Machine describe_machine();

/// The most memory that this process has had resident, in units of 10^6 bytes; nothing where the system does
/// not report it.
std::optional<double> peak_resident_megabytes();

/// The memory that this process may still take, in units of 10^6 bytes.
struct MemoryLimit {
  double megabytes;
  std::string of;               ///< "this machine", "ulimit -v" (RLIMIT_AS), "ulimit -d", "the control group"
  bool is_of_a_process = false; ///< each process has as much for itself
};

/// The smallest of the limits on this process, whatever others use: the machine's memory, its control
/// group's, its address space.
MemoryLimit memory_limit();

/// Why this process has too little address space (ulimit -v) for libraries to start, as one line; empty when
/// it has enough. OpenBLAS looks for memory without end where there is none.
/// @param megabytes  that they take until the first solve, in units of 10^6 bytes
std::string why_not_to_start(double megabytes);

/// One thread inside BLAS: cases and MPI ranks are what fills the cores here, and pools multiply. It takes
/// its work space at once, before solves may leave no room for it.
/// @return whether the BLAS that this process loaded is OpenBLAS, the only one that is told
bool use_one_blas_thread();

class Stopwatch {
 public:
  /// Wall-clock seconds since construction or the last lap().
  double seconds() const {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    return elapsed.count();
  }
  double lap() { return std::exchange(*this, Stopwatch()).seconds(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace springproof::compare
