#pragma once

#include "compare/table/json.hpp"
#include "msm/design/design.hpp"

namespace springproof::compare {

/// A design's springs in a few words: "k_e, k_f, k_d = 31, 47, 33 N/m", "12 springs of 50, 6 of 50 N/m in a
/// cell", "5 tetrahedra in a cell".
std::string springs_text(const msm::DesignResult& design);

/// stiffness_N_per_m (null where the cells are not of four stiffnesses), volume_stiffness_MPa, exponents if
/// there are any, and `cell`, the springs of a cell one by one, where there are no four stiffnesses.
nlohmann::ordered_json springs_to_json(const msm::DesignResult& design);

} // namespace springproof::compare
