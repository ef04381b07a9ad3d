#include "cases/names.hpp"
#include "compare/thesis/build_results.hpp"
#include "compare/thesis/measured_pair.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace compare {

namespace {

bool is_sound(const Comparison& msm) {
  return msm.msm.solution.status == cases::Status::converged &&
         msm.msm.solution.outcome == cases::Outcome::stable_equilibrium &&
         msm.msm.solution.inverted_cells == 0;
}

/// The case file's material and cell, which the stiffnesses are made independent of.
msm::CellStiffness over_modulus_and_edge(const msm::CellStiffness& k, const cases::Scene& scene) {
  const double youngs_modulus = std::get<cases::LinearElastic>(scene.definition.material).youngs_modulus;
  const double edge = msm::cube_edge(cases::cell_vertices(scene.mesh, 0));
  const double scale = youngs_modulus * edge;
  return {k.edge / scale, k.face_diagonal / scale, k.internal_diagonal / scale, k.volume / youngs_modulus};
}

Advice::Errors errors_on_cube(PublishedFigure figure, const std::string& load_set, SolveSet& solves,
                              Advice& advice) {
  Advice::Errors errors;
  errors.is_stable = true;
  double worst = 0, sum = 0, worst_volume = 0;
  int n = 0;
  bool is_whole = true;
  figure.load_set = load_set;
  for (const char* test : {"tensile", "shear", "torsion"}) {
    figure.test = test;
    const Comparison& fem = solves.get(fem_job(figure, references_of(figure).front()));
    const Comparison& msm = solves.get(designed_msm_job(figure, advice.design));
    errors.is_stable = errors.is_stable && is_sound(msm);
    if (msm.design) advice.stiffness = over_modulus_and_edge(msm.design->stiffness, msm.scene);
    for (const MeasuredValue& measure : fem.measures) {
      const MeasuredPair pair = measured_pair(fem, msm, measure.name);
      const std::optional<double> error = error_of(pair);
      if (!error) {
        is_whole = false;
        if (advice.refusal.empty()) advice.refusal = fmt::format("{} {}: {}", load_set, test, pair.reason);
      } else if (measure.name == "volume") {
        worst_volume = std::max(worst_volume, std::abs(*error));
      } else {
        worst = std::max(worst, std::abs(*error));
        sum += std::abs(*error);
        ++n;
      }
    }
  }
  if (!is_whole || n == 0) return errors;
  errors.worst = worst;
  errors.mean = sum / n;
  errors.worst_volume = worst_volume;
  return errors;
}

Advice advise_on(double poissons_ratio, const std::string& design, SolveSet& solves) {
  Advice advice;
  advice.poissons_ratio = poissons_ratio;
  advice.design = design;
  const PublishedFigure figure{"", "linear_elastic", poissons_ratio, design, poissons_ratio, "", "", "", "%",
                               0};
  advice.small = errors_on_cube(figure, "small", solves, advice);
  advice.large = errors_on_cube(figure, "large", solves, advice);
  // With E = 1 MPa and a cell of 1 mm, the stiffnesses in N/m are a thousand times those over E L0.
  advice.trace.command = shell_command({"build/springproof", "design", "--young", "1", "--poisson",
                                        fmt::format("{}", poissons_ratio), "--method", design});
  return advice;
}

/// Over both load sets; nothing for a design that failed or is not stable somewhere.
std::optional<double> worst_error(const Advice& advice) {
  if (!advice.small.is_stable || !advice.large.is_stable || !advice.small.worst || !advice.large.worst)
    return std::nullopt;
  return std::max(*advice.small.worst, *advice.large.worst);
}

} // namespace

void recommend(std::vector<Advice>& advice) {
  for (Advice& candidate : advice) {
    const auto worst = worst_error(candidate);
    candidate.is_recommended =
        worst && std::none_of(advice.begin(), advice.end(), [&](const Advice& other) {
          const auto others = worst_error(other);
          const bool is_rival = other.poissons_ratio == candidate.poissons_ratio && &other != &candidate;
          return is_rival && others && (*others < *worst || (*others == *worst && &other < &candidate));
        });
  }
}

std::vector<Advice> advise(SolveSet& solves) {
  std::vector<Advice> advice;
  for (const double nu : {0.2, 0.3, 0.35, 0.45, 0.49})
    for (const auto& [method, name] : cases::names<cases::Design>())
      if (method != cases::Design::given) advice.push_back(advise_on(nu, name, solves));
  recommend(advice);
  return advice;
}

} // namespace compare
