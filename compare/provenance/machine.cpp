#include "compare/provenance/machine.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <fstream>
#include <mpi.h>
#include <sys/utsname.h>
#include <thread>

namespace springproof::compare {

namespace {

/// OpenBLAS' own functions are looked up in what is loaded: any BLAS may be installed, and only OpenBLAS has
/// them.
template<class Function>
Function* find_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

/// What follows "KEY...:" and a character in a file of the system.
std::optional<std::string> value_in(const char* file, const char* key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(key, 0) == 0) return line.substr(line.find(':') + 2);
  return std::nullopt;
}

} // namespace

std::string cases_folder() {
  const char* moved = std::getenv("SPRINGPROOF_CASES");
  return moved ? moved : SPRINGPROOF_CASES_DIR;
}

int mpi_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

/// Not getrusage(): its figure is inherited from the process that started this one.
std::optional<double> peak_resident_megabytes() {
  const auto kibibytes = value_in("/proc/self/status", "VmHWM:");
  return kibibytes ? std::optional(std::stod(*kibibytes) * 1024e-6) : std::nullopt;
}

bool use_one_blas_thread() {
  auto* const set_threads = find_function<void(int)>("openblas_set_num_threads");
  if (set_threads) set_threads(1);
  return set_threads != nullptr;
}

Machine describe_machine() {
  utsname system{};
  uname(&system);
  auto* config = find_function<char*()>("openblas_get_config");
  return {value_in("/proc/cpuinfo", "model name").value_or("unknown"),
          static_cast<int>(std::thread::hardware_concurrency()),
          std::string(system.sysname) + " " + system.release + " " + system.machine, "g++ " __VERSION__,
          config ? config() : "not OpenBLAS"};
}

} // namespace springproof::compare
