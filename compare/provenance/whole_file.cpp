#include "compare/provenance/whole_file.hpp"

#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "compare/provenance/machine.hpp"

#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <set>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

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

/// @param path  what a message calls the place
void write_to(const std::string& place, const std::string& path,
              const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream file(place, std::ios::binary);
  if (file) write(file);
  file.close();
  if (!file) refuse(path, std::generic_category().message(errno != 0 ? errno : EIO));
}

/// Leaves nothing behind. A disk that is nearly full lets no small file's worth of bytes through.
void try_to_write(const std::string& place, const std::string& path) {
  std::error_code ignored;
  const fs::path parent = fs::path(place).parent_path();
  if (!parent.empty()) fs::create_directories(parent, ignored);
  fs::remove(place, ignored);
  try {
    write_to(place, path, [](std::ostream& out) { out << std::string(1 << 16, ' '); });
  } catch (...) {
    fs::remove(place, ignored);
    throw;
  }
  fs::remove(place, ignored);
}

/// Copies owner and mode from the file that is to be replaced; what is refused stays as it is.
void keep_owner_and_mode(const fs::path& target, const fs::path& place) {
  struct stat old {};
  if (lstat(target.c_str(), &old) != 0 || !S_ISREG(old.st_mode)) return;
  [[maybe_unused]] const int is_refused = chown(place.c_str(), old.st_uid, old.st_gid);
  chmod(place.c_str(), old.st_mode & 0777);
}

/// A folder where a file of results may be written: renaming does not replace it. Subfolders have files
/// alone.
bool is_in_the_way(const fs::directory_entry& entry, bool is_in_subfolder) {
  static const std::set<std::string> of_results{".csv", ".gp",  ".html", ".json",
                                                ".png", ".svg", ".txt",  ".vtu"};
  return fs::is_directory(entry.symlink_status()) &&
         (is_in_subfolder || of_results.count(entry.path().extension().string()) > 0);
}

/// @param is_subfolder  whether it lies in `--out`'s folder: then it must be no link
void claim(const std::string& folder, bool is_subfolder) {
  if (folder.empty() || mpi_rank() != 0) return;
  std::error_code error;
  fs::create_directories(folder, error);
  const int descriptor =
      open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | (is_subfolder ? O_NOFOLLOW : 0));
  if (descriptor < 0) refuse(folder, error ? error.message() : std::generic_category().message(errno));
  // The lock goes with the process. File systems that have none go without it.
  const bool is_locked = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  if (!is_locked && errno == EWOULDBLOCK) refuse(folder, "another springproof writes into it");
  try_to_write(folder + "/try" + unfinished, folder);
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == unfinished)
      left.push_back(entry.path());
    else if (is_in_the_way(entry, is_subfolder))
      refuse(entry.path().string(), std::generic_category().message(EISDIR));
  if (!is_locked) return; // what is unfinished may be another's work
  for (const fs::path& path : left) fs::remove(path, error);
}

} // namespace

void make_file(const std::string& path, const std::function<void(const std::string& temporary)>& make) {
  const fs::path target(path), place = path + unfinished;
  std::error_code error, ignored;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), ignored);
  fs::remove(place, ignored); // leftover of a killed run
  try {
    make(place);
    keep_owner_and_mode(target, place);
    fs::rename(place, target, error);
    if (error) refuse(path, error.message());
  } catch (...) {
    fs::remove(place, ignored);
    throw;
  }
}

void write_file(const std::string& path, const std::function<void(std::ostream&)>& write) {
  make_file(path, [&](const std::string& place) { write_to(place, path, write); });
}

void write_named_file(const std::string& path, const std::function<void(std::ostream&)>& write) {
  if (is_special(path))
    write_to(path, path, write);
  else
    write_file(path, write);
}

void check_named_file(const std::string& path) {
  if (path.empty() || mpi_rank() != 0) return;
  if (fs::is_directory(path)) refuse(path, std::generic_category().message(EISDIR));
  if (!is_special(path))
    try_to_write(path + unfinished, path);
  else if (fs::exists(path) &&
           access(path.c_str(), W_OK) != 0) // a link may lead to a file that is to be made
    refuse(path, std::generic_category().message(errno));
}

std::string read_file(const std::string& path) {
  return cases::read_bytes(path);
}

void claim_folder(const std::string& folder) {
  claim(folder, false);
}

void claim_subfolder(const std::string& folder, const std::string& name) {
  claim(folder.empty() ? "" : folder + "/" + name, true);
}

} // namespace springproof::compare
