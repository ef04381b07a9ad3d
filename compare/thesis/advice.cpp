#include "cases/case/names.hpp"
#include "compare/thesis/build_results.hpp"
#include "compare/thesis/measured_pair.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

bool is_sound(const Comparison& msm) {
  return msm.answers.msm.solution.status == cases::Status::converged &&
         msm.answers.msm.solution.outcome == cases::Outcome::stable_equilibrium &&
         msm.answers.msm.solution.inverted_cells == 0;
}

/// The case file's material and cell, which the stiffnesses are made independent of.
msm::CellStiffness over_modulus_and_edge(const msm::CellStiffness& k, const cases::Scene& scene) {
  const double youngs_modulus = std::get<cases::LinearElastic>(scene.definition.material).youngs_modulus;
  const double edge = msm::cube_edge(cases::cell_vertices(scene.mesh, 0));
  const double scale = youngs_modulus * edge;
  return {k.edge / scale, k.face_diagonal / scale, k.internal_diagonal / scale, k.volume / youngs_modulus};
}

/// Errors of one load set, gathered measure by measure.
class ErrorSum {
 public:
  void add(const std::string& measure, double error, const Trace& trace) {
    const double size = std::abs(error);
    if (measure == "volume") {
      worst_volume_ = std::max(worst_volume_, size);
      return;
    }
    sum_ += size;
    ++n_;
    if (n_ > 1 && size <= worst_) return;
    worst_ = size;
    trace_ = trace;
  }
  void write_into(Advice::Errors& errors) const {
    if (n_ == 0) return;
    errors.worst = worst_;
    errors.mean = sum_ / n_;
    errors.worst_volume = worst_volume_;
    errors.trace = trace_;
  }

 private:
  double worst_ = 0, sum_ = 0, worst_volume_ = 0;
  int n_ = 0;
  Trace trace_;
};

Advice::Errors errors_on_cube(PublishedFigure figure, const std::string& load_set, SolveSet& solves,
                              Advice& advice) {
  Advice::Errors errors;
  errors.is_stable = true;
  ErrorSum sum;
  bool is_whole = true;
  figure.load_set = load_set;
  for (const char* test : {"tensile", "shear", "torsion"}) {
    figure.test = test;
    const SolveJob fem_side = fem_job(figure, references_of(figure).front()),
                   msm_side = designed_msm_job(figure, advice.design);
    const Comparison &fem = solves.get(fem_side), &msm = solves.get(msm_side);
    errors.is_stable = errors.is_stable && is_sound(msm);
    if (msm.answers.design)
      advice.stiffness = over_modulus_and_edge(msm.answers.design->stiffness, msm.scene);
    for (const MeasuredValue& measure : fem.measures) {
      const MeasuredPair pair = measured_pair(fem, msm, measure.name);
      if (const std::optional<double> error = error_of(pair)) {
        sum.add(measure.name, *error, trace_of(fem_side, msm_side));
        continue;
      }
      is_whole = false;
      if (advice.refusal.empty()) advice.refusal = fmt::format("{} {}: {}", load_set, test, pair.reason);
    }
  }
  if (is_whole) sum.write_into(errors);
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

} // namespace springproof::compare
