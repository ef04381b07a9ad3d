#include "compare/peers/displacement_file.hpp"

#include "cases/case/error.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <optional>

namespace springproof::compare {

namespace {

/// A tag of the file's XML, <Name key="value" ...>, and where the text behind it begins.
struct Tag {
  std::string text;
  std::size_t end = 0;

  /// Value of an attribute, or nothing.
  std::optional<std::string> attribute(const std::string& key) const {
    const std::size_t at = text.find(" " + key + "=\"");
    if (at == std::string::npos) return std::nullopt;
    const std::size_t begin = at + key.size() + 3;
    return text.substr(begin, text.find('"', begin) - begin);
  }
};

/// A .vtu as far as it is needed here: tags are found by their names, and the block of raw bytes at the end
/// is left alone. (A reader of XML would stumble over that block, which is not XML.)
class VtuFile {
 public:
  VtuFile(const std::string& text, const std::string& path) : text_(text), path_(path) {
    const std::size_t block = text.find("<AppendedData");
    end_of_xml_ = std::min(block, text.size());
    if (block != std::string::npos) appended_ = text.find('_', text.find('>', block)) + 1;
    const auto root = find("VTKFile", 0, end_of_xml_);
    if (!root || root->attribute("type") != "UnstructuredGrid")
      refuse("is no VTK file of type UnstructuredGrid");
    if (root->attribute("compressor")) refuse("is compressed, must be ascii or appended raw");
    if (root->attribute("byte_order").value_or("LittleEndian") != "LittleEndian")
      refuse("must be of byte_order LittleEndian");
    has_long_sizes_ = root->attribute("header_type") == "UInt64";
    const auto piece = find("Piece", 0, end_of_xml_);
    if (!piece || find("Piece", piece->end, end_of_xml_)) refuse("must hold one <Piece>");
    n_points_ = static_cast<std::size_t>(number(piece->attribute("NumberOfPoints").value_or("none")));
  }

  std::size_t n_points() const { return n_points_; }

  /// The tags <DataArray> between <section> and </section>.
  std::vector<Tag> arrays_in(const std::string& section) const {
    std::vector<Tag> arrays;
    const auto open = find(section, 0, end_of_xml_);
    if (!open) return arrays;
    const std::size_t close = std::min(text_.find("</" + section + ">", open->end), end_of_xml_);
    for (auto tag = find("DataArray", open->end, close); tag; tag = find("DataArray", tag->end, close))
      arrays.push_back(*tag);
    return arrays;
  }

  /// Three finite components per point.
  std::vector<Eigen::Vector3d> vectors(const Tag& array) const {
    const std::string format = array.attribute("format").value_or("ascii");
    const std::string type = array.attribute("type").value_or("none");
    std::vector<double> values;
    if (type != "Float32" && type != "Float64")
      refuse_array(array, "is of type " + type + ", must be Float32 or Float64");
    if (format == "ascii")
      values = ascii(array);
    else if (format == "appended" && appended_)
      values = type == "Float64" ? raw<double>(array) : raw<float>(array);
    else
      refuse_array(array, "has the format " + format + ", must be ascii or appended (raw)");
    if (values.size() != 3 * n_points_)
      refuse_array(
          array, fmt::format("has {} numbers, must have 3 for each of {} points", values.size(), n_points_));
    std::vector<Eigen::Vector3d> result;
    for (std::size_t p = 0; p < n_points_; ++p) {
      result.emplace_back(values[3 * p], values[3 * p + 1], values[3 * p + 2]);
      if (!result.back().allFinite()) refuse_array(array, fmt::format("is not finite at point {}", p));
    }
    return result;
  }

  [[noreturn]] void refuse(const std::string& problem) const {
    throw cases::InputError(path_ + ": " + problem);
  }

 private:
  [[noreturn]] void refuse_array(const Tag& array, const std::string& problem) const {
    refuse(fmt::format("the array '{}' {}", array.attribute("Name").value_or(""), problem));
  }

  std::optional<Tag> find(const std::string& name, std::size_t from, std::size_t to) const {
    for (std::size_t at = text_.find("<" + name, from); at < to; at = text_.find("<" + name, at + 1)) {
      const char next = text_[at + 1 + name.size()]; // <Points is not <PointsOfView
      if (next != ' ' && next != '>' && next != '\n' && next != '\t' && next != '/') continue;
      const std::size_t end = text_.find('>', at);
      if (end >= to) refuse("breaks off within <" + name);
      Tag tag{text_.substr(at, end - at), end + 1};
      for (char& c : tag.text)
        if (c == '\n' || c == '\t' || c == '\r') c = ' ';
      return tag;
    }
    return std::nullopt;
  }

  double number(const std::string& word) const {
    double value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size() || !(value >= 0) || !(value <= 1e10))
      refuse("'" + word + "' is no whole number from 0 on");
    return value;
  }

  std::vector<double> ascii(const Tag& array) const {
    const char* at = text_.data() + array.end;
    const char* const end = text_.data() + std::min(text_.find('<', array.end), end_of_xml_);
    std::vector<double> values;
    const auto skip = [&] {
      while (at != end && std::isspace(static_cast<unsigned char>(*at))) ++at;
    };
    for (skip(); at != end; skip()) {
      double value = 0;
      const auto [stop, error] = std::from_chars(at, end, value);
      if (error != std::errc())
        refuse_array(array,
                     fmt::format("holds '{}', which is no number", std::string(at, std::min(at + 12, end))));
      values.push_back(value);
      at = stop;
    }
    return values;
  }

  /// An array of the appended block: its size in bytes, and its values.
  template<class Value>
  std::vector<double> raw(const Tag& array) const {
    const std::size_t offset = static_cast<std::size_t>(number(array.attribute("offset").value_or("none")));
    const std::size_t begin = *appended_ + offset;
    std::uint64_t size = 0;
    const std::size_t width = has_long_sizes_ ? 8 : 4;
    if (begin + width > text_.size()) refuse_array(array, "begins behind the end of the file");
    std::memcpy(&size, text_.data() + begin, width);
    if (size > text_.size() - begin - width) refuse_array(array, "ends behind the end of the file");
    std::vector<Value> values(size / sizeof(Value));
    std::memcpy(values.data(), text_.data() + begin + width, values.size() * sizeof(Value));
    return {values.begin(), values.end()};
  }

  const std::string& text_;
  std::string path_;
  std::size_t end_of_xml_ = 0;
  std::optional<std::size_t> appended_; ///< first byte of the block
  bool has_long_sizes_ = false;
  std::size_t n_points_ = 0;
};

/// The array of displacements: by its name, or because there is no other.
Tag displacement_array(const VtuFile& file) {
  std::vector<Tag> vectors;
  for (const Tag& array : file.arrays_in("PointData"))
    if (array.attribute("NumberOfComponents") == "3") vectors.push_back(array);
  std::string names;
  for (const char* wanted : {"msm_displacement", "displacement"})
    for (const Tag& array : vectors)
      if (array.attribute("Name") == wanted) return array;
  if (vectors.size() == 1) return vectors.front();
  for (const Tag& array : vectors) names += " '" + array.attribute("Name").value_or("") + "'";
  file.refuse(
      "must have point data of three components named msm_displacement or displacement, or only one with "
      "three components; it has" +
      (names.empty() ? " none" : names));
}

} // namespace

std::vector<GivenDisplacement> read_displacement_vtu(const std::string& text, const std::string& path) {
  const VtuFile file(text, path);
  const std::vector<Tag> points = file.arrays_in("Points");
  if (points.size() != 1) file.refuse("must have one array of <Points>");
  const auto positions = file.vectors(points.front());
  const auto displacements = file.vectors(displacement_array(file));
  std::vector<GivenDisplacement> nodes;
  for (std::size_t p = 0; p < positions.size(); ++p)
    nodes.push_back({positions[p], displacements[p], fmt::format("{}: point {}", path, p)});
  return nodes;
}

} // namespace springproof::compare
