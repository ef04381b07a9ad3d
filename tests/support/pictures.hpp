#pragma once

#include "cases/case/error.hpp"
#include "cases/mesh/labels.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <fmt/format.h>
#include <string>

/// A small picture in the formats that bodies are made of.
namespace springproof::pictures {

using namespace cases;

/// 12 x 3 x 2 voxels of 1 x 2 x 3 mm: 100 below 6 mm of x, 50 from there to 9 mm, 0 beyond.
inline Volume picture() {
  Volume volume{{12, 3, 2}, {1, 2, 3}, {}};
  for (int v = 0; v < 72; ++v) volume.intensities.push_back(v % 12 < 6 ? 100 : v % 12 < 9 ? 50 : 0);
  return volume;
}

inline Labels bone_and_fat(double edge, const std::string& path = "") {
  Labels labels;
  labels.file.path = path;
  labels.edge = edge;
  labels.classes = {{"bone", 80, 120, true}, {"fat", 40, 60, false}};
  return labels;
}

template<class Number>
std::string bytes_of_picture(bool swapped = false) {
  std::string bytes;
  for (const float intensity : picture().intensities) {
    const Number number = static_cast<Number>(intensity);
    std::string one(sizeof number, '\0');
    std::memcpy(one.data(), &number, sizeof number);
    bytes += swapped ? std::string(one.rbegin(), one.rend()) : one;
  }
  return bytes;
}

/// Header (352 bytes) of a NIfTI file of int16.
inline std::string nifti(std::array<std::int16_t, 3> sizes, float slope = 1, float intercept = 0) {
  std::string header(352, '\0');
  const auto put = [&](std::size_t at, auto value) { std::memcpy(&header[at], &value, sizeof value); };
  put(0, std::int32_t{348});
  put(40, std::int16_t{3});
  for (std::size_t a = 0; a < 3; ++a) {
    put(42 + 2 * a, sizes[a]);
    put(80 + 4 * a, static_cast<float>(a + 1));
  }
  for (std::size_t a = 3; a < 7; ++a) put(42 + 2 * a, std::int16_t{1});
  put(70, std::int16_t{4}); // int16
  put(72, std::int16_t{16});
  put(108, 352.f);
  put(112, slope);
  put(116, intercept);
  std::memcpy(&header[344], "n+1", 4);
  return header;
}

/// A NIfTI file of single precision.
inline std::string nifti_of(const Volume& volume) {
  std::array<std::int16_t, 3> sizes{};
  for (std::size_t a = 0; a < 3; ++a) sizes[a] = static_cast<std::int16_t>(volume.voxels[a]);
  std::string file = nifti(sizes);
  const auto put = [&](std::size_t at, auto value) { std::memcpy(&file[at], &value, sizeof value); };
  for (std::size_t a = 0; a < 3; ++a) put(80 + 4 * a, static_cast<float>(volume.spacing[int(a)]));
  put(70, std::int16_t{16}); // float
  put(72, std::int16_t{32});
  const std::size_t header = file.size(), bytes = sizeof(float) * volume.intensities.size();
  file.resize(header + bytes);
  std::memcpy(&file[header], volume.intensities.data(), bytes);
  return file;
}

/// The picture's NIfTI file with some bytes of its header set.
class Nifti {
 public:
  explicit Nifti(std::string content = nifti({12, 3, 2}) + bytes_of_picture<std::int16_t>())
      : content_(std::move(content)) {}
  template<class Value>
  Nifti& put(std::size_t at, Value value) {
    std::memcpy(&content_[at], &value, sizeof value);
    return *this;
  }
  Nifti& lengths(double by) {
    for (std::size_t a = 0; a < 3; ++a) put(80 + 4 * a, static_cast<float>(by * double(a + 1)));
    return *this;
  }
  Nifti& units(char code) { return put(123, code); }
  Nifti& map(std::int16_t sform, const Eigen::Matrix3f& steps, std::int16_t qform = 0,
             const Eigen::Vector3f& offset = {0, 0, 0}) {
    put(252, qform).put(254, sform);
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t a = 0; a < 3; ++a) put(280 + 16 * row + 4 * a, steps(int(row), int(a)));
      put(292 + 16 * row, offset[int(row)]);
    }
    return *this;
  }
  /// Its qform.  @param quaternion  b, c, d
  Nifti& turn(float qfac, const Eigen::Vector3f& quaternion, const Eigen::Vector3f& offset) {
    put(76, qfac);
    for (std::size_t a = 0; a < 3; ++a) put(256 + 4 * a, quaternion[int(a)]).put(268 + 4 * a, offset[int(a)]);
    return *this;
  }
  operator std::string() const { return content_; }

 private:
  std::string content_;
};

/// A member of a tar.
inline std::string member(const std::string& name, const std::string& content) {
  std::string header(512, '\0');
  const auto put = [&](std::size_t at, const std::string& text) { header.replace(at, text.size(), text); };
  put(0, name);
  put(100, "0000644");
  put(124, fmt::format("{:011o}", content.size()));
  put(136, "00000000000");
  put(148, "        ");
  put(156, "0");
  put(257, std::string("ustar\0"
                       "00",
                       8));
  unsigned sum = 0;
  for (const char c : header) sum += static_cast<unsigned char>(c);
  put(148, fmt::format("{:06o}", sum));
  header[154] = '\0';
  return header + content + std::string((512 - content.size() % 512) % 512, '\0');
}

inline std::string
plist(const std::string& shape = "<integer>2</integer><integer>3</integer><integer>12</integer>") {
  return "<?xml version=\"1.0\"?><plist><dict><key>matrix</key><dict><key>dtype</key><string>int16</string>"
         "<key>filename</key><string>matrix.dat</string><key>shape</key><array>" +
         shape +
         "</array></dict><key>spacing</key><array><real>1</real><real>2</real><real>3</real></array></dict></"
         "plist>";
}

inline std::string project(const std::string& list, const std::string& voxels) {
  return member("a/matrix.dat", voxels) + member("a/main.plist", list) + std::string(1024, '\0');
}

inline void check_is_picture(const std::string& path) {
  const Mesh mesh = make_label_mesh(bone_and_fat(1, path));
  REQUIRE(mesh.grid);
  CHECK(mesh.grid->cells == std::array<int, 3>{9, 6, 6}); // the last three of 12 along x are empty
  CHECK(mesh.cells.size() == 9 * 6 * 6);
  CHECK(std::count(mesh.group_of_cell.begin(), mesh.group_of_cell.end(), "bone") == 6 * 6 * 6);
  CHECK(centre_of(mesh, mesh.cells[0]) == Eigen::Vector3d(0.5, 0.5, 0.5));
  CHECK(mesh.group_of_cell[6] == "fat"); // fat is beyond the bone in x, as voxels are numbered
}

inline std::string refusal(const Labels& labels) {
  try {
    make_label_mesh(labels);
  } catch (const InputError& error) {
    const std::string message = error.what();
    CHECK(message.find('\n') == std::string::npos);
    return message;
  }
  return "none";
}

} // namespace springproof::pictures
