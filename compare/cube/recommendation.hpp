#pragma once

#include "compare/cube/cube_benchmark.hpp"

namespace springproof::compare {

/// Which of the measured designs to use for the request's material, its worst error and why, and what a case
/// takes that names no design; or why none is recommended.
std::string recommendation_text(const std::vector<DesignAttempt>& attempts,
                                const msm::DesignRequest& request);

} // namespace springproof::compare
