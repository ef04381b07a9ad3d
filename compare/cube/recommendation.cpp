#include "compare/cube/recommendation.hpp"

#include "cases/case/names.hpp"
#include "cases/case/readers.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// The measured attempts that are stable in every test, but one.
std::vector<DesignAttempt> rivals_of(const DesignAttempt& best, const std::vector<DesignAttempt>& attempts) {
  std::vector<DesignAttempt> rivals;
  for (const DesignAttempt& a : attempts)
    if (&a != &best && a.cube && worst_if_stable(*a.cube)) rivals.push_back(a);
  return rivals;
}

/// "alpha_1 under large loads": where the worst error is.
std::string place_of_worst(const CubeErrors& cube) {
  for (const auto& [name, errors] : {std::pair("small", &cube.small), std::pair("large", &cube.large)})
    for (const CubeError& m : errors->measures)
      if (m.error_percent && std::abs(*m.error_percent) == cube.worst())
        return fmt::format("{} under {} loads", m.measure, name);
  return "";
}

/// What speaks for the design without a name.
std::string reason_for(const DesignAttempt& by_default, const DesignAttempt& best) {
  const auto strain = [](const DesignAttempt& a) { return a.stability ? stable_strain(*a.stability) : 0; };
  if (!(strain(by_default) > strain(best)))
    return "its rule asks for a large lattice that stays stable, not for this cube alone";
  return fmt::format("its lattice is stable to logarithmic strains of {:.2f}, that of {} to {:.2f}",
                     strain(by_default), best.name, strain(best));
}

std::string default_text(const DesignAttempt& best, const std::vector<DesignAttempt>& attempts,
                         const msm::DesignRequest& request) {
  const std::string name =
      cases::name_of(cases::default_design({request.material}, request.options.poissons_ratio));
  if (name == best.name) return " A case that names no design takes it too.";
  for (const DesignAttempt& a : attempts)
    if (a.name == name && a.cube && a.cube->worst())
      return fmt::format(" A case that names no design takes {}, with {:.2f} %: {}.", name, *a.cube->worst(),
                         reason_for(a, best));
  return fmt::format(" A case that names no design takes {}.", name);
}

} // namespace

std::string recommendation_text(const std::vector<DesignAttempt>& attempts,
                                const msm::DesignRequest& request) {
  const DesignAttempt* best = recommended(attempts);
  if (!best) return "None is recommended: no design is stable in every test of the cube.";
  const cases::LinearElastic material = msm::small_strain_material(request.material);
  std::string text = fmt::format(
      "Use {} for E = {:.4g} MPa and nu = {:.4g}: its worst error on the thesis's cube is {:.2f} % ({}), its "
      "worst volume error {:.2f} %.",
      best->name, material.youngs_modulus, request.options.poissons_ratio.value_or(material.poissons_ratio),
      *best->cube->worst(), place_of_worst(*best->cube), best->cube->worst_volume().value_or(0));
  const std::vector<DesignAttempt> rivals = rivals_of(*best, attempts);
  if (const DesignAttempt* next = recommended(rivals))
    text +=
        fmt::format(" That is the smallest of the {} designs that are stable in every test; the next is {} "
                    "with {:.2f} %.",
                    rivals.size() + 1, next->name, *next->cube->worst());
  return text + default_text(*best, attempts, request);
}

} // namespace springproof::compare
