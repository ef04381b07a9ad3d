#include "compare/sweep/variant_cost.hpp"

#include "compare/solve/estimate.hpp"

namespace springproof::compare {

std::vector<double> estimated_costs(const Sweep& sweep) {
  std::vector<double> costs;
  for (const Variant& variant : sweep.plan.variants) {
    const cases::Side side = variant.program == Program::springs ? cases::Side::msm : cases::Side::fem;
    costs.push_back(estimated_cost({cases::make_scene(with_variant(sweep.definition, variant)), {side}}));
  }
  return costs;
}

} // namespace springproof::compare
