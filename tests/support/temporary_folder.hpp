#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

/// A folder of a test's own, which goes with it.
struct TemporaryFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("springproof-test-" + std::to_string(::getpid()) + "-" + std::to_string(count()++));
  TemporaryFolder() { std::filesystem::create_directories(path); }
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
  /// A file in it, and where it is.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  static int& count() {
    static int n = 0;
    return n;
  }
};
