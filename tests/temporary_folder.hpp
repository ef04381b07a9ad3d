#pragma once

#include <filesystem>
#include <string>
#include <unistd.h>

/// A folder of a test's own, which goes with it.
struct TemporaryFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("springproof-test-" + std::to_string(::getpid()) + "-" + std::to_string(count()++));
  TemporaryFolder() { std::filesystem::create_directories(path); }
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  static int& count() {
    static int n = 0;
    return n;
  }
};
