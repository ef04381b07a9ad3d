#pragma once

#include "cases/scene/scene.hpp"
#include "compare/solve/answers.hpp"

#include <optional>
#include <string>
#include <vector>

namespace springproof::compare {

/// A measure on both sides. A side that failed or was skipped has no value.
struct MeasuredValue {
  std::string name;
  std::string unit;
  std::optional<double> fem;
  std::optional<double> msm;
  std::optional<double> error_percent;
  std::optional<double> peer = std::nullopt; ///< by another program, when it was asked
};

/// All measures of a case, in its order.
std::vector<MeasuredValue> measure(const cases::Scene& scene, const Answers& answers);

} // namespace springproof::compare
