#include "compare/write/whole_file.hpp"

#include "cases/case/error.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <unistd.h>

namespace springproof::compare {

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

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw cases::InputError(path + ": cannot be read");
  return content;
}

} // namespace springproof::compare
