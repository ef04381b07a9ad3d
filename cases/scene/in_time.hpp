#pragma once

#include "cases/scene/scene.hpp"

/// A dynamic case's scene at single times, and what is watched of it.
namespace springproof::cases {

/// The static scene whose equilibrium a motion may start from: loads and motions by their factors just before
/// time 0, at full load, without [dynamics].
Scene scene_before_start(const Scene& scene);

/// Whether the factor of a load follows time.
bool has_load_histories(const Scene& scene);

/// Whether the factor of a load or a moved region jumps after time 0 and before the motion's end.
/// @param scene  a dynamic case's
bool jumps_on_the_way(const Scene& scene);

/// Nodes that the case's measures look at, ascending.
std::vector<int> watched_nodes(const Scene& scene);

/// Whether one of its measures needs the body's volume.
bool watches_volume(const Scene& scene);

} // namespace springproof::cases
