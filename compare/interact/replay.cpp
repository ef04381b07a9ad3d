#include "compare/interact/recording.hpp"

#include "cases/scene/loads.hpp"
#include "compare/measure/surfaces.hpp"
#include "mechanics/surface/embedded_surface.hpp"

#include <fmt/format.h>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

constexpr std::size_t most_loaded = 1'000'000; ///< vertices of the surface and nodes, of all places

/// A hold's force along an axis (N): constant in a step; jumps follow the ends, at which schemes look.
cases::History history_of(const Hold& hold, int axis, double step) {
  const auto just_after = [&](long n) { return (static_cast<double>(n) + 1e-6) * step; };
  cases::History history;
  long n = hold.first_step - 1;
  history.points.push_back({just_after(n), 0});
  for (const Vector3d& force : hold.force) {
    history.points.push_back({just_after(n), force[axis]});
    history.points.push_back({just_after(++n), force[axis]});
  }
  history.points.push_back({just_after(n), 0});
  return history;
}

bool is_of_tools(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \r\n\t");
  return begin != std::string::npos &&
         text.compare(begin, tool_recording_header.size(), tool_recording_header) == 0;
}

cases::Scene with_tools_led(cases::Scene scene, const std::string& text, const std::string& path) {
  const cases::Dynamics& dynamics = *scene.definition.dynamics;
  std::vector<cases::Tool>& tools = scene.definition.tools;
  const auto paths = read_tool_recording(text, path, dynamics.step, dynamics.end, tools.size());
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const Vector3d begin = tools[i].place(0);
    tools[i].path = paths[i];
    if (paths[i].empty()) tools[i].path.push_back({0, begin.x(), begin.y(), begin.z()});
  }
  return scene;
}

} // namespace

cases::Scene with_recording(cases::Scene scene, const std::string& text, const std::string& path) {
  cases::refuse_network(scene.definition, "--replay, whose pulls are at a surface",
                        "a history in [[load]] pulls at nodes");
  const auto& dynamics = scene.definition.dynamics;
  if (!dynamics) throw cases::InputError(scene.definition.file + ": has no [dynamics] to replay pulls in");
  if (is_of_tools(text)) return with_tools_led(std::move(scene), text, path);
  for (cases::Tool& tool : scene.definition.tools) { // they have stayed where they were
    const Vector3d place = tool.place(0);
    tool.path = {{0, place.x(), place.y(), place.z()}};
  }
  const std::vector<Hold> holds = read_recording(text, path, dynamics->step, dynamics->end);
  const mechanics::EmbeddedSurface surface = embedded_surface(scene);
  // A load of the case on a plane of symmetry is the whole body's; a pull is of the part that was pulled.
  const auto share = cases::modelled_share(scene);
  std::size_t n_loaded = 0;
  for (const Hold& hold : holds) {
    cases::Scene::AppliedLoad patch;
    patch.points = mechanics::patch_within(surface, hold.centre, hold.radius);
    if (patch.points.empty())
      throw cases::InputError(
          fmt::format("{}: step {}: no vertex of the case's surface lies within {:.6g} mm of "
                      "({:.6g}, {:.6g}, {:.6g}): it is of another body",
                      path, hold.first_step, hold.radius, hold.centre.x(), hold.centre.y(), hold.centre.z()));
    cases::give_to_nodes(patch, scene.mesh, share);
    n_loaded += patch.points.size() + patch.selection.nodes.size();
    if (n_loaded > most_loaded)
      throw cases::InputError(
          fmt::format("{}: pulls {} nodes and vertices in all, may pull {}: fewer places or smaller ones",
                      path, n_loaded, most_loaded));
    for (int axis = 0; axis < 3; ++axis) {
      patch.load.kind = cases::loads::NodalForce{Vector3d::Unit(axis)}; // N, times the factor
      patch.load.history = history_of(hold, axis, dynamics->step);
      scene.loads.push_back(patch);
    }
  }
  return scene;
}

} // namespace springproof::compare
