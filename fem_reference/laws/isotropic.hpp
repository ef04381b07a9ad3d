#pragma once

#include "fem_reference/laws/point.hpp"
#include "mechanics/laws/in_principal_stretches.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/ogden.hpp"
#include "mechanics/laws/saint_venant_kirchhoff.hpp"
#include "mechanics/laws/small_strain.hpp"

namespace springproof::fem_reference {

using SmallStrain = AtPoint<mechanics::SmallStrain>;
using SaintVenantKirchhoff = AtPoint<mechanics::SaintVenantKirchhoff>;
using LogStrain = AtPoint<mechanics::InPrincipalStretches<mechanics::LogStrain>>;
using Ogden = AtPoint<mechanics::InPrincipalStretches<mechanics::Ogden>>;

} // namespace springproof::fem_reference
