#pragma once

namespace springproof::cases {

/// The two models that are compared. (Hard cases name a design of the springs beside them.)
enum class Side { msm, hybrid, fem };

} // namespace springproof::cases
