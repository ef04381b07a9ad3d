#include "compare/provenance/whole_file.hpp"

#include "cases/case/error.hpp"
#include "compare/provenance/machine.hpp"

#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/file.h>
#include <unistd.h>

namespace springproof::compare {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw cases::InputError("cannot write '" + path + "': " + reason);
}

/// A device, a pipe or a link, which renaming would replace by a file.
bool is_special(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  return fs::is_other(status) || fs::is_symlink(status);
}

} // namespace

void make_file(const std::string& path, const std::function<void(const std::string& temporary)>& make) {
  const bool is_renamed = !is_special(path);
  const fs::path target(path), place = is_renamed ? path + ".part" : path;
  std::error_code error, ignored;
  if (is_renamed) {
    if (target.has_parent_path()) fs::create_directories(target.parent_path(), ignored);
    fs::remove(place, ignored); // of a run that was killed
  }
  try {
    make(place);
    if (is_renamed) fs::rename(place, target, error);
    if (error) refuse(path, error.message());
  } catch (...) {
    if (is_renamed) fs::remove(place, ignored);
    throw;
  }
}

void write_file(const std::string& path, const std::function<void(std::ostream&)>& write) {
  make_file(path, [&](const std::string& place) {
    errno = 0;
    std::ofstream file(place, std::ios::binary);
    if (file) write(file);
    file.close();
    if (!file) refuse(path, std::generic_category().message(errno != 0 ? errno : EIO));
  });
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  try {
    if (file) return {std::istreambuf_iterator<char>(file), {}};
  } catch (const std::ios_base::failure&) {
    // a folder opens, but it cannot be read
  }
  throw cases::InputError(path + ": cannot be read");
}

void claim_folder(const std::string& folder) {
  if (folder.empty() || mpi_rank() != 0) return;
  std::error_code error;
  fs::create_directories(folder, error);
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 || access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(folder, std::generic_category().message(errno));
  // The lock goes with the process. File systems that have none go without it.
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse(folder, "another springproof writes into it");
}

} // namespace springproof::compare
