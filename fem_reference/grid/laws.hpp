#pragma once

#include "mechanics/laws/in_principal_stretches.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/ogden.hpp"
#include "mechanics/laws/saint_venant_kirchhoff.hpp"
#include "mechanics/laws/small_strain.hpp"

namespace springproof::fem_reference::grid {

/// The isotropic laws of mechanics/laws.
enum class Law { small_strain, saint_venant_kirchhoff, log_strain, ogden };

/// Returns action(law), the law being a type.
template<class Action>
SPRINGPROOF_INLINE auto with_law(Law law, const Action& action) {
#pragma GCC diagnostic error "-Wswitch" // a law that is forgotten here must not compile
  switch (law) {
  case Law::small_strain:
    return action(mechanics::SmallStrain{});
  case Law::saint_venant_kirchhoff:
    return action(mechanics::SaintVenantKirchhoff{});
  case Law::log_strain:
    return action(mechanics::InPrincipalStretches<mechanics::LogStrain>{});
  case Law::ogden:
    break;
  }
  return action(mechanics::InPrincipalStretches<mechanics::Ogden>{});
}

} // namespace springproof::fem_reference::grid
