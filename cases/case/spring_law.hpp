#pragma once

#include "cases/case/enumeration.hpp"

namespace springproof::cases {

/// How a spring's tension follows its stretch q.
SPRINGPROOF_ENUMERATION(SpringLaw,
                        hooke,    ///< k l0 (q - 1), and a volume term of pressure k_v (J - 1)
                        power_log ///< k l0 q^p ln q, and k_v ln J
)

} // namespace springproof::cases
