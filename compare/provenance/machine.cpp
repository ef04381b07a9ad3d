#include "compare/provenance/machine.hpp"

#include "cases/case/installation.hpp"
#include "mechanics/ranks/share_out.hpp"

#include <algorithm>
#include <cstdlib>
#include <dlfcn.h>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <mpi.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <thread>
#include <vector>

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

/// "VmRSS:   154592 kB" of this process or the machine, in 10^6 bytes.
std::optional<double> megabytes_in(const char* file, const char* key) {
  const auto kibibytes = value_in(file, key);
  return kibibytes ? std::optional(std::stod(*kibibytes) * 1024e-6) : std::nullopt;
}

/// Files that may hold the limit of this process's control group, of either version. Inside a container the
/// group is the root of what is mounted.
std::vector<std::string> control_group_files() {
  std::vector<std::string> files{"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"};
  std::ifstream groups("/proc/self/cgroup"); // lines of number:controllers:path
  for (std::string line; std::getline(groups, line);) {
    const std::string path = line.substr(line.rfind(':') + 1);
    if (line.rfind("0::", 0) == 0) files.push_back("/sys/fs/cgroup" + path + "/memory.max");
    if (line.find(":memory:") != std::string::npos)
      files.push_back("/sys/fs/cgroup/memory" + path + "/memory.limit_in_bytes");
  }
  return files;
}

} // namespace

std::string cases_folder() {
  const char* moved = std::getenv("SPRINGPROOF_CASES");
  return moved ? moved : cases::data_folder("cases");
}

int mpi_rank() {
  int rank = 0;
  if (mechanics::is_mpi_started()) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int n_mpi_ranks() {
  int n = 1;
  if (mechanics::is_mpi_started()) MPI_Comm_size(MPI_COMM_WORLD, &n);
  return n;
}

int n_mpi_ranks_here() {
  for (const char* name : {"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"}) // Open MPI, MPICH
    if (const char* n = std::getenv(name); n && std::atoi(n) > 0)
      return std::min(std::atoi(n), n_mpi_ranks());
  return n_mpi_ranks();
}

/// Not getrusage(): its figure is inherited from the process that started this one.
std::optional<double> peak_resident_megabytes() {
  return megabytes_in("/proc/self/status", "VmHWM:");
}

MemoryLimit memory_limit() {
  const double resident = megabytes_in("/proc/self/status", "VmRSS:").value_or(0);
  MemoryLimit least{std::numeric_limits<double>::infinity(), "", false};
  const auto take = [&](double megabytes, const char* of) {
    if (megabytes < least.megabytes) least = {megabytes, of, false};
  };
  if (const auto machine = megabytes_in("/proc/meminfo", "MemTotal:"))
    take(*machine - resident, "this machine");
  for (const std::string& name : control_group_files()) {
    double bytes = 0;
    if (std::ifstream(name) >> bytes) take(1e-6 * bytes - resident, "the control group"); // "max": no number
  }
  const auto take_limit = [&](auto resource, const char* used, const char* of) {
    rlimit limit{};
    if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      take(1e-6 * double(limit.rlim_cur) - megabytes_in("/proc/self/status", used).value_or(0), of);
  };
  take_limit(RLIMIT_AS, "VmSize:", "ulimit -v");
  take_limit(RLIMIT_DATA, "VmData:", "ulimit -d");
  least.is_of_a_process = least.of.rfind("ulimit", 0) == 0;
  return least;
}

std::string why_not_to_start(double megabytes) {
  constexpr rlim_t n_files = 32; // 20 are open at a time; with fewer MPI crashes
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0 && files.rlim_cur < n_files)
    return fmt::format("ulimit -n allows {} open files, and the libraries need {} to start", files.rlim_cur,
                       n_files);
  const MemoryLimit limit = memory_limit();
  if (!limit.is_of_a_process || limit.megabytes >= megabytes) return "";
  return fmt::format("{} leaves {:.0f} MB of memory, and the libraries need {:.0f} to start", limit.of,
                     std::max(0., limit.megabytes), megabytes);
}

bool use_one_blas_thread() {
  auto* const set_threads = find_function<void(int)>("openblas_set_num_threads");
  if (!set_threads) return false;
  set_threads(1);
  using Multiply =
      void(const char*, const char*, const int*, const int*, const int*, const double*, const double*,
           const int*, const double*, const int*, const double*, double*, const int*);
  if (auto* const multiply = find_function<Multiply>("dgemm_")) {
    constexpr int n = 128; // products of up to 1e6 multiplications need no work space
    constexpr double one = 1, zero = 0;
    std::vector<double> zeros(n * n), product(n * n);
    multiply("N", "N", &n, &n, &n, &one, zeros.data(), &n, zeros.data(), &n, &zero, product.data(), &n);
  }
  return true;
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
