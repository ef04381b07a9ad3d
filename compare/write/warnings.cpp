#include "compare/write/warnings.hpp"

#include "cases/scene/loads.hpp"

namespace springproof::compare {

std::vector<std::string> warnings_of(const Comparison& comparison) {
  std::vector<std::string> all = cases::warnings_of_loads(comparison.scene);
  const auto add = [&all](const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(comparison.scene.remarks);
  add(comparison.answers.msm_warnings);
  if (const auto& design = comparison.answers.design) add(design->warnings);
  return all;
}

} // namespace springproof::compare
