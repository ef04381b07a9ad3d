#include "compare/provenance/machine.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <fstream>
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

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

} // namespace

std::string cases_folder() {
  const char* moved = std::getenv("SPRINGPROOF_CASES");
  return moved ? moved : SPRINGPROOF_CASES_DIR;
}

/// Not getrusage(): its figure is inherited from the process that started this one.
std::optional<double> peak_resident_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) * 1024e-6; // KiB
  return std::nullopt;
}

bool blas_is_openblas() {
  return find_function<char*()>("openblas_get_config") != nullptr;
}

void use_one_blas_thread() {
  if (auto* set_threads = find_function<void(int)>("openblas_set_num_threads")) set_threads(1);
}

Machine describe_machine() {
  utsname system{};
  uname(&system);
  auto* config = find_function<char*()>("openblas_get_config");
  return {processor_name(), static_cast<int>(std::thread::hardware_concurrency()),
          std::string(system.sysname) + " " + system.release + " " + system.machine, "g++ " __VERSION__,
          config ? config() : "not OpenBLAS"};
}

} // namespace springproof::compare
