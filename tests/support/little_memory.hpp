#pragma once

#include <fstream>
#include <string>
#include <sys/resource.h>

/// Limits the process to so many more bytes of address space, as long as the object lives.
class LittleMemory {
 public:
  explicit LittleMemory(std::size_t more_bytes) {
    getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0; // the first number: those the process has
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{pages * 4096 + more_bytes, before_.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
  }
  ~LittleMemory() { setrlimit(RLIMIT_AS, &before_); }
  LittleMemory(const LittleMemory&) = delete;
  LittleMemory& operator=(const LittleMemory&) = delete;

 private:
  rlimit before_{};
};
