#include "cases/mesh/surface.hpp"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <sstream>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

constexpr std::size_t binary_head = 84,
                      binary_triangle = 50; ///< bytes: 80 of text and a count; 12 floats and 2 more

std::string content(const std::string& path, const Where& where) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) throw InputError(where, path + ": cannot be read, or is empty");
  return text.str();
}

template<class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value;
  std::memcpy(&value, bytes.data() + at,
              sizeof value); // STL is little-endian, and so is every machine we run on
  return value;
}

Surface read_binary(const std::string& bytes, std::size_t n_triangles) {
  Surface surface(n_triangles);
  for (std::size_t t = 0; t < n_triangles; ++t)
    for (std::size_t v = 0; v < 3; ++v)
      for (std::size_t a = 0; a < 3; ++a) // the first three floats are the normal
        surface[t][v][static_cast<Eigen::Index>(a)] = static_cast<double>(
            number_at<float>(bytes, binary_head + binary_triangle * t + sizeof(float) * (3 + 3 * v + a)));
  return surface;
}

/// "vertex x y z" three times for each triangle; the words between them say nothing more.
Surface read_text_surface(const std::string& text, const std::string& path, const Where& where) {
  Surface surface;
  std::vector<Vector3d> vertices;
  std::istringstream lines(text);
  std::string line, word;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    if (!(words >> word)) continue;
    const bool is_end = word == "endfacet";
    if (word == "vertex") {
      std::array<std::string, 3> coordinates;
      words >> coordinates[0] >> coordinates[1] >> coordinates[2];
      Vector3d vertex;
      for (std::size_t a = 0; a < 3; ++a) {
        char* end = nullptr;
        vertex[static_cast<Eigen::Index>(a)] = std::strtod(coordinates[a].c_str(), &end);
        if (coordinates[a].empty() || *end != 0)
          throw InputError(where, fmt::format("{}:{}: is no \"vertex x y z\"", path, number));
      }
      vertices.push_back(vertex);
    }
    if (is_end && vertices.size() != 3)
      throw InputError(
          where, fmt::format("{}:{}: a facet of {} vertices, must have 3", path, number, vertices.size()));
    if (is_end) {
      surface.push_back({vertices[0], vertices[1], vertices[2]});
      vertices.clear();
    }
  }
  if (!vertices.empty()) throw InputError(where, path + ": ends within a facet");
  return surface;
}

} // namespace

Surface read_stl(const std::string& path, const Where& where) {
  const std::string bytes = content(path, where);
  const std::size_t n = bytes.size() >= binary_head ? number_at<std::uint32_t>(bytes, 80) : 0;
  // A binary file may begin with "solid" too, as a text does: its length is what tells.
  const bool is_binary = bytes.size() >= binary_head && bytes.size() == binary_head + binary_triangle * n;
  if (!is_binary && bytes.rfind("solid", 0) != 0)
    throw InputError(
        where, path + ": is no STL: a text begins with \"solid\", a binary file is 84 bytes and 50 for each "
                      "triangle that it counts");
  const Surface surface = is_binary ? read_binary(bytes, n) : read_text_surface(bytes, path, where);
  if (surface.empty()) throw InputError(where, path + ": has no triangles");
  for (const auto& triangle : surface)
    for (const Vector3d& vertex : triangle)
      if (!vertex.allFinite()) throw InputError(where, path + ": has a position that is not finite");
  return surface;
}

std::size_t n_open_edges(const Surface& surface) {
  using Point = std::array<double, 3>;
  std::map<std::array<Point, 2>, long> balance; // of the edges between two points: one way less the other way
  const auto point = [](const Vector3d& v) {
    return Point{v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};
  }; // -0 is 0
  for (const auto& triangle : surface)
    for (std::size_t v = 0; v < 3; ++v) {
      const Point a = point(triangle[v]), b = point(triangle[(v + 1) % 3]);
      if (a < b) ++balance[{a, b}];
      if (b < a) --balance[{b, a}];
    }
  std::size_t open = 0;
  for (const auto& [edge, difference] : balance) open += static_cast<std::size_t>(std::labs(difference));
  return open;
}

} // namespace springproof::cases
