#include "cases/mesh/volume_files.hpp"

#include "cases/case/letters.hpp"
#include "cases/case/rows.hpp"
#include "cases/mesh/voxel_size.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace springproof::cases {

namespace {

/// VTK reads as much to find a header's end.
constexpr std::size_t longest_header = 0x400000;
constexpr int first_of_gzip = 0x1f;

std::string without_blanks_around(const std::string& text) {
  const char* const blanks = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
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

using HeaderLines = std::map<std::string, std::string>; ///< values of keys, both in small letters

/// @throws std::runtime_error unless the header has the key  @return its value
const std::string& value_in(const HeaderLines& lines, const std::string& key) {
  const auto found = lines.find(key);
  if (found == lines.end()) throw std::runtime_error("has a header without '" + key + "'");
  return found->second;
}

void check_value(const HeaderLines& lines, const std::string& key, const std::vector<std::string>& allowed) {
  const std::string& value = value_in(lines, key);
  if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return;
  std::string list;
  for (const std::string& one : allowed) list += (list.empty() ? "" : " or ") + one;
  throw std::runtime_error("has a header with " + key + " '" + value.substr(0, 100) + "', must be " + list);
}

std::vector<std::string> words_in(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// @throws std::runtime_error unless the key's value is so many numbers and no more
std::vector<double> numbers_of(const HeaderLines& lines, const std::string& key, std::size_t n) {
  std::string text = value_in(lines, key);
  if (key == "space directions") // of vectors: (1,0,0) (0,1,0) (0,0,1)
    for (char& c : text)
      if (c == '(' || c == ')' || c == ',') c = ' ';
  std::vector<double> numbers;
  const std::vector<std::string> words = words_in(text);
  for (const std::string& word : words)
    if (const auto number = number_in<double>(word)) numbers.push_back(*number);
  if (words.size() != n || numbers.size() != n)
    throw std::runtime_error("has a header with " + key + " '" + value_in(lines, key).substr(0, 100) +
                             "', must be " + std::to_string(n) + " numbers with points and without units");
  return numbers;
}

/// Of NRRD: a size of its own for each axis, or the steps between voxels in space, each with its unit.
Eigen::Vector3d voxel_of_nrrd(const HeaderLines& lines) {
  const bool has_spacings = lines.count("spacings") > 0, has_directions = lines.count("space directions") > 0;
  if (has_spacings == has_directions)
    throw std::runtime_error(std::string("has a header with ") +
                             (has_spacings ? "'spacings' and" : "neither 'spacings' nor") +
                             " 'space directions', must have one of them: the size of its voxels");
  const Eigen::Vector3d edges =
      has_spacings
          ? Eigen::Vector3d(numbers_of(lines, "spacings", 3).data())
          : edges_of_voxel(Eigen::Matrix3d(numbers_of(lines, "space directions", 9).data())); // by columns
  const char* const key = has_spacings && lines.count("units") > 0 ? "units" : "space units";
  if (lines.count(key) == 0) return edges;
  std::vector<std::string> units;
  std::istringstream quoted(value_in(lines, key));
  for (std::string unit; std::getline(quoted, unit, '"') && std::getline(quoted, unit, '"');)
    units.push_back(unit);
  if (units.size() != 3)
    throw std::runtime_error(std::string("has a header with ") + key + " '" +
                             value_in(lines, key).substr(0, 100) + "', must be three in quotes");
  return edges.cwiseProduct(
      Eigen::Vector3d(millimetres_in(units[0]), millimetres_in(units[1]), millimetres_in(units[2])));
}

Eigen::Vector3d voxel_of_meta(const HeaderLines& lines) {
  for (const char* key : {"transformmatrix", "rotation", "orientation"})
    if (lines.count(key) > 0) {
      const Eigen::Vector3d edges = edges_of_voxel(Eigen::Matrix3d(numbers_of(lines, key, 9).data()));
      if (!((edges.array() - 1).abs() <= voxel_tolerance).all())
        throw std::runtime_error(std::string("has a header with a ") + key +
                                 " that is no rotation: elementspacing has to say the size of its voxels");
    }
  const auto unit = lines.find("distanceunits");
  return Eigen::Vector3d(numbers_of(lines, "elementspacing", 3).data()) *
         (unit == lines.end() ? 1 : millimetres_in(unit->second));
}

/// What the format requires of a header. VTK crashes without sizes, reads text from a wrong place and takes
/// this machine's order of bytes where none is said.
void check_nrrd(const HeaderLines& lines) {
  const std::string& type = value_in(lines, "type");
  check_value(lines, "dimension", {"3"});
  if (words_in(value_in(lines, "sizes")).size() != 3) throw std::runtime_error("must have three sizes");
  check_value(lines, "encoding", {"raw", "gzip", "gz"});
  const bool is_of_bytes = type.find("char") != std::string::npos || type.find("int8") != std::string::npos;
  if (!is_of_bytes) check_value(lines, "endian", {"little", "big"});
  for (const char* key : {"byte skip", "byteskip", "line skip", "lineskip"}) // which VTK does not
    if (lines.count(key) > 0) check_value(lines, key, {"0"});
}

std::uint64_t whole_number(const std::string& text) {
  const bool is_one =
      !text.empty() && text.size() < 19 && text.find_first_not_of("0123456789") == std::string::npos;
  return is_one ? std::strtoull(text.c_str(), nullptr, 10) : 0;
}

void check_meta(const HeaderLines& lines, VolumeHeader& header) {
  check_value(lines, "ndims", {"3"});
  value_in(lines, "dimsize");
  value_in(lines, "elementtype");
  value_in(lines, "elementdatafile");
  check_value(lines, "binarydata", {"true"});
  if (lines.count("headersize") != 0) {
    const std::string& size = value_in(lines, "headersize");
    header.skipped = whole_number(size);
    if (header.skipped == 0 && size != "0" && size != "-1")
      throw std::runtime_error("has a header with headersize '" + size.substr(0, 100) +
                               "', must be -1, 0 or a number of bytes");
  }
  if (!header.is_compressed) return;
  header.compressed = whole_number(value_in(lines, "compresseddatasize"));
  if (header.compressed == 0)
    throw std::runtime_error("has a header with a compresseddatasize that is no number of bytes above 0");
}

/// @throws std::runtime_error if the file is a link that leads out of its folder
void check_is_in(const std::filesystem::path& folder, const std::filesystem::path& file) {
  if (std::filesystem::canonical(file).parent_path() != std::filesystem::canonical(folder))
    throw std::runtime_error("is a link to another folder");
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
  HeaderLines values;
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
    values[key] = word;
    if (key == "encoding") header.is_compressed = word != "raw";
    if (key == "compresseddata") header.is_compressed = word != "false";
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
  if (is_nrrd)
    check_nrrd(values);
  else
    check_meta(values, header);
  header.voxel = is_nrrd ? voxel_of_nrrd(values) : voxel_of_meta(values);
  if (!(header.voxel.array() > 0).all())
    throw std::runtime_error("has a header with a size of its voxels that must be above 0");
  return header;
}

VolumeBytes bytes_of_volume(const std::string& path) {
  const std::uint64_t bytes = size_of_regular_file(path), most_compressed = 1040;
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".nii") return {bytes, bytes};
  std::ifstream stream(path, std::ios::binary);
  if (ending == ".gz" || ending == ".inv3") {
    const bool is_plain_tar = ending == ".inv3" && stream.peek() != first_of_gzip;
    return {bytes, most_compressed * bytes,
            is_plain_tar ? std::nullopt : std::optional(Deflated{path, 0, bytes})};
  }
  std::string beginning(std::min<std::uint64_t>(bytes, longest_header), '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  if ((ending == ".nrrd" || ending == ".nhdr") && beginning.rfind("NRRD", 0) != 0)
    throw std::runtime_error("is no NRRD: does not begin with that word");
  const VolumeHeader header = header_of_volume(beginning);
  const std::uint64_t of_header = std::min(bytes, header.bytes);
  std::uint64_t with_voxels = bytes - of_header;
  Deflated deflated{path, of_header + header.skipped, 0};
  if (!header.file.empty()) try {
      const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
      with_voxels = size_of_regular_file((folder / header.file).string());
      check_is_in(folder, folder / header.file);
      deflated = {(folder / header.file).string(), header.skipped, 0};
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("names '" + header.file.substr(0, 200) + "' for its voxels: " + error.what());
    }
  const std::uint64_t in_files = header.file.empty() ? bytes : bytes + with_voxels;
  with_voxels -= std::min(with_voxels, header.skipped);
  if (header.compressed > with_voxels)
    throw std::runtime_error("is cut short: says that its voxels take " + std::to_string(header.compressed) +
                             " bytes, has " + std::to_string(with_voxels));
  if (!header.is_compressed) return {in_files, with_voxels, {}, header.voxel};
  deflated.bytes = header.compressed > 0 ? header.compressed : with_voxels;
  return {in_files, most_compressed * with_voxels, deflated, header.voxel};
}

} // namespace springproof::cases
