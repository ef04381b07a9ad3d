#include "cases/scene/surface.hpp"

#include "cases/mesh/label_surface.hpp"
#include "cases/mesh/read_surface.hpp"

#include <fmt/format.h>

namespace springproof::cases {

void read_surface_of(Scene& scene) {
  constexpr std::size_t most = 5'000'000;
  const auto& file = scene.definition.surface;
  if (!file) return;
  const auto refuse = [&](const std::string& reason) {
    const bool has_path = reason.find(file->path) != std::string::npos;
    throw InputError(file->where, has_path ? reason : file->path + ": " + reason);
  };
  try {
    scene.surface = file->contour ? label_surface(std::get<Labels>(scene.definition.body), *file->contour)
                                  : read_surface(file->path);
  } catch (const std::runtime_error& error) {
    refuse(error.what());
  }
  if (scene.surface.triangles.size() > most)
    refuse(fmt::format("has {} triangles, must have at most {}", scene.surface.triangles.size(), most));
}

} // namespace springproof::cases
