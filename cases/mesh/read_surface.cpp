#include "cases/mesh/read_surface.hpp"

#include "cases/mesh/confined.hpp"
#include "cases/mesh/read_vtk.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace springproof::cases {

namespace {

TriangleMesh with_triangles(const Surface& surface) {
  TriangleMesh mesh = joined(surface);
  if (mesh.triangles.empty()) throw std::runtime_error("has no triangle with three different corners");
  return mesh;
}

} // namespace

TriangleMesh read_surface(const std::string& path, std::vector<std::string>* remarks) {
  if (std::filesystem::path(path).extension() == ".stl") return with_triangles(read_triangles(path, remarks));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  return with_triangles(surface_from(
      run_confined([&] { return bytes_of(vtk().read_polygons(content)); }, limits_to_read(content.size()))));
}

TriangleMesh contour(const Picture& picture, const ContourSettings& settings) {
  double n_values = 1;
  for (const int n : picture.n_points) n_values *= n;
  if (!(std::all_of(picture.n_points.begin(), picture.n_points.end(), [](int n) { return n > 0; }) &&
        n_values == static_cast<double>(picture.values.size())))
    throw std::runtime_error("a picture has not as many values as points");
  constexpr std::uint64_t per_value = 4; // bytes of a file with as much work
  return with_triangles(surface_from(run_confined([&] { return bytes_of(vtk().contour(picture, settings)); },
                                                  limits_to_read(per_value * picture.values.size()))));
}

TriangleMesh decimated(const TriangleMesh& surface, std::size_t n_triangles) {
  constexpr std::uint64_t per_triangle = 50; // bytes of a file with as much work
  Limits limits = limits_to_read(per_triangle * surface.triangles.size());
  limits.seconds = 20;
  const auto& functions = vtk(); // loaded before the child is confined
  return with_triangles(surface_from(
      run_confined([&] { return bytes_of(functions.decimated(surface, n_triangles)); }, limits)));
}

} // namespace springproof::cases
