#pragma once

#include "cases/scene/loads.hpp"

#include <vector>

namespace springproof::mechanics {

/// A load of a scene in motion.
struct LoadOnNodes {
  cases::History history;
  std::vector<cases::NodeVector> force; ///< N, at a factor of 1
};

/// All loads of a scene, gravity among them.  @param mass  t, one per point
inline std::vector<LoadOnNodes> loads_in_time(const cases::Scene& scene, const std::vector<double>& mass) {
  std::vector<LoadOnNodes> loads;
  for (const auto& applied : scene.loads)
    loads.push_back({applied.load.history, applied.load.on() == cases::loads::On::masses
                                               ? cases::weights(mass, cases::acceleration_of(applied.load))
                                               : cases::loaded_nodes(scene, {applied})});
  return loads;
}

} // namespace springproof::mechanics
