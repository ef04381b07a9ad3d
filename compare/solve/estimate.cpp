#include "compare/solve/estimate.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::compare {

/// Unknowns times the steps and the cost of an element, as measured on the thesis's cases.
double estimated_cost(const Question& question) {
  const auto& [scene, request] = question;
  const double n_nodes = static_cast<double>(scene.mesh.nodes.size());
  const cases::Fem& fem = scene.definition.fem;
  double cost = 0;
  const int refine = std::max(fem.refine, request.meshes - 1);
  if (request.asks(cases::Side::fem))
    cost += n_nodes * std::pow(8, refine) * (fem.formulation == cases::Formulation::small_strain ? 2 : 10);
  if (request.asks(cases::Side::msm)) cost += n_nodes;
  return cost;
}

} // namespace springproof::compare
