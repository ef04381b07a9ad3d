#include "cases/mesh/volume_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace springproof::cases {

namespace {

/// VTK reads as much to find a header's end.
constexpr std::size_t longest_header = 0x400000;

std::string without_blanks_around(const std::string& text) {
  const char* const blanks = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string in_small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// @throws std::runtime_error unless it is the name of a file in the same folder
void check_is_beside(const std::string& name) {
  const bool is_one_name = name.find_first_of("/\\% \t") == std::string::npos && name != "." &&
                           name != ".." && name.rfind("LIST", 0) != 0;
  if (!is_one_name)
    throw std::runtime_error(
        "names '" + name.substr(0, 200) +
        "' for its voxels, must be the name of one file in its own folder, without blanks");
}

std::uint64_t size_of_regular_file(const std::string& path) {
  std::error_code absent;
  if (!std::filesystem::is_regular_file(path, absent))
    throw std::runtime_error(absent ? absent.message() : "is no regular file");
  return std::filesystem::file_size(path);
}

} // namespace

VolumeHeader header_of_volume(const std::string& beginning) {
  std::istringstream lines(beginning);
  const bool is_nrrd = beginning.rfind("NRRD", 0) == 0; // whose header ends with an empty line
  bool has_end = !is_nrrd;
  VolumeHeader header;
  for (std::string line; std::getline(lines, line);) {
    header.bytes = std::min(beginning.size(), static_cast<std::size_t>(header.bytes) + line.size() + 1);
    if (is_nrrd && (line.empty() || line == "\r")) {
      has_end = true;
      break;
    }
    const std::size_t at = line.find_first_of(":=");
    if (at == std::string::npos) continue;
    const std::string key = in_small_letters(without_blanks_around(line.substr(0, at)));
    const std::string value = without_blanks_around(line.substr(at + 1)), word = in_small_letters(value);
    if (key == "encoding") header.is_compressed = word != "raw";
    if (key == "compresseddata") header.is_compressed = word != "false";
    if (key == "binarydata") header.is_compressed = header.is_compressed || word == "false";
    if (key == "elementdatafile" && word == "local") break; // its last line: voxels follow
    if (key != "data file" && key != "datafile" && key != "elementdatafile") continue;
    check_is_beside(value);
    header.file = value;
    if (key == "elementdatafile") break;
  }
  // VTK reads the last line of a header for ever that ends with the file or a zero byte.
  const std::string text = beginning.substr(0, static_cast<std::size_t>(header.bytes));
  has_end = has_end || (text.size() == beginning.size() && text.back() == '\n');
  if (is_nrrd && (!has_end || text.find('\0') != std::string::npos))
    throw std::runtime_error("has a header without an end, which is an empty line");
  return header;
}

VolumeBytes bytes_of_volume(const std::string& path) {
  const std::uint64_t bytes = size_of_regular_file(path), most_compressed = 1040;
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".nii") return {bytes, bytes};
  if (ending == ".gz" || ending == ".inv3") return {bytes, most_compressed * bytes};
  std::ifstream stream(path, std::ios::binary);
  std::string beginning(std::min<std::uint64_t>(bytes, longest_header), '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  const VolumeHeader header = header_of_volume(beginning);
  std::uint64_t with_voxels = bytes - std::min(bytes, header.bytes);
  if (!header.file.empty()) try {
      with_voxels = size_of_regular_file((std::filesystem::path(path).parent_path() / header.file).string());
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("names '" + header.file.substr(0, 200) + "' for its voxels: " + error.what());
    }
  return {header.file.empty() ? bytes : bytes + with_voxels,
          header.is_compressed ? most_compressed * with_voxels : with_voxels};
}

} // namespace springproof::cases
