#include "compare/solve/kept.hpp"

#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/frame.hpp"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace springproof::compare {

namespace {

/// First line of a kept file. To be counted up when the fields of compare/solve/fields.hpp change their
/// meaning.
const std::string heading = "springproof answers, format 5\n";

} // namespace

const std::string& this_program() {
  static const std::string identity =
      program_version() + " " + program_commit() + " " + digest(read_file("/proc/self/exe"));
  return identity;
}

std::string identity_of(const std::string& question) {
  const char* petsc = std::getenv("PETSC_OPTIONS");
  return digest(cases::to_bytes<cereal::BinaryOutputArchive>(this_program(), std::string(petsc ? petsc : ""),
                                                             question));
}

void write_kept(const std::string& path, const std::string& identity, const std::string& result) {
  const std::string content = framed({identity, result});
  write_file(path, [&](std::ostream& out) { out << heading << content; });
}

std::string read_kept(const std::string& path, const std::string& identity) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return "";
  std::string content = read_file(path);
  if (content.compare(0, heading.size(), heading) != 0)
    throw std::runtime_error("has another format than this program's");
  content.erase(0, heading.size());
  const std::optional<Frame> frame = take_frame(content);
  if (!frame || !content.empty()) throw std::runtime_error("is damaged");
  return frame->kind == identity ? frame->content : "";
}

} // namespace springproof::compare
