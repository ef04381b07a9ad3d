#include "mechanics/equilibrium/turns.hpp"

#include "cases/case/turns_in_time.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::mechanics {

EquilibriumSettings in_small_turns(double degrees, int at_least, EquilibriumSettings settings) {
  const double way = std::abs(settings.to - settings.from);
  const double n_steps = std::max(std::ceil(std::abs(degrees) * way / cases::largest_turn_of_step),
                                  std::ceil(at_least * way - 1e-9));
  if (!(n_steps > 1)) return settings;
  for (double* step : {&settings.first_load_step, &settings.largest_load_step})
    *step = std::min(*step, 1 / n_steps);
  // Some halvings must be left.
  settings.smallest_load_step = std::min(settings.smallest_load_step, settings.largest_load_step / 16);
  return settings;
}

} // namespace springproof::mechanics
