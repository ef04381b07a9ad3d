#include "compare/atomic_file.hpp"

#include "cases/error.hpp"

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace compare {

void write_file(const std::string& path, const std::function<void(std::ostream&)>& write) {
  namespace fs = std::filesystem;
  const fs::path target(path);
  const fs::path temporary = path + ".part" + std::to_string(getpid());
  std::error_code error;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
  std::ofstream file(temporary, std::ios::binary);
  if (file) write(file);
  file.close();
  if (file) fs::rename(temporary, target, error);
  if (!file || error) {
    fs::remove(temporary, error);
    throw cases::InputError("cannot write '" + path + "'");
  }
}

} // namespace compare
