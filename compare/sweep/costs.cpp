#include "compare/sweep/costs.hpp"

#include "compare/provenance/print.hpp"
#include "compare/solve/progress.hpp"

#include <algorithm>
#include <numeric>

namespace springproof::compare {

namespace {

constexpr double process_seconds = 0.5; ///< to start a process, and to read and send
constexpr double seconds_in_this_process = 0.01;
constexpr double again_part = 0.7; ///< of the first solve's time, which a re-solve takes

double sum(const std::vector<double>& seconds) {
  return std::accumulate(seconds.begin(), seconds.end(), 0.);
}

/// The variants of one method.
struct Method {
  std::string name;
  std::size_t n_variants = 0;
  Estimate largest; ///< by memory; seconds of all
};

std::vector<Method> methods_of_plan(const Sweep& sweep) {
  std::vector<Method> methods;
  for (const Variant& variant : sweep.plan.variants) {
    const std::string name = method_name(variant);
    auto found =
        std::find_if(methods.begin(), methods.end(), [&](const Method& m) { return m.name == name; });
    if (found == methods.end()) found = methods.insert(methods.end(), {name, 0, {}});
    const Estimate estimate = estimate_of(sweep, variant);
    ++found->n_variants;
    found->largest.unknowns = std::max(found->largest.unknowns, estimate.unknowns);
    found->largest.megabytes = std::max(found->largest.megabytes, estimate.megabytes);
    found->largest.seconds += estimate.seconds;
  }
  return methods;
}

} // namespace

Estimate estimate_of(const Sweep& sweep, const Variant& variant) {
  const BodySize body = size_of(with_variant(sweep.definition, variant)).value(); // a box
  Estimate model = variant.program == Program::springs ? estimate_springs(body) : estimate_fem(body);
  const int n = n_repetitions(model.seconds, sweep.rules);
  const double rounds = n == 0 ? 1 : (1 + n) * (1 + again_part); // a first one to warm up
  const bool has_process = sweep.processes == Processes::one_per_variant;
  model.seconds = (has_process ? process_seconds : seconds_in_this_process) + rounds * model.seconds;
  return model;
}

std::vector<double> estimated_seconds(const Sweep& sweep) {
  std::vector<double> seconds;
  for (const Variant& variant : sweep.plan.variants) seconds.push_back(estimate_of(sweep, variant).seconds);
  return seconds;
}

void cut_to_budget(Sweep& sweep, double budget_seconds) {
  std::vector<double> seconds = estimated_seconds(sweep);
  std::vector<Variant>& variants = sweep.plan.variants;
  const auto first =
      static_cast<std::ptrdiff_t>(sweep.plan.reference.size()); // which comes before the others
  double all = sum(seconds);
  while (all > budget_seconds && seconds.size() > sweep.plan.reference.size()) {
    const auto longest = std::max_element(seconds.begin() + first, seconds.end());
    const auto variant = variants.begin() + (longest - seconds.begin());
    sweep.plan.left_out.push_back(
        {full_name(*variant), fmt::format("its estimated {:.2g} s do not fit into the budget of {:g} s",
                                          *longest, budget_seconds)});
    all -= *longest;
    variants.erase(variant);
    seconds.erase(longest);
  }
}

void check_memory(const Sweep& sweep) {
  const MemoryLimit limit = memory_limit();
  for (const Variant& variant : sweep.plan.variants)
    check_memory(sweep.definition.file + ", " + full_name(variant), {estimate_of(sweep, variant)}, limit);
}

void write_plan(std::ostream& out, const Sweep& sweep) {
  print(out, "{}: {} variants, about {} in all (minutes:seconds)\n", sweep.definition.name,
        sweep.plan.variants.size(), clock_text(sum(estimated_seconds(sweep))));
  for (const auto& [name, n_variants, largest] : methods_of_plan(sweep))
    print(out, "  {:<34} {:>3} variants, up to {:>9.0f} unknowns and {:>6.0f} MB, {:>7}\n", name, n_variants,
          largest.unknowns, largest.megabytes, clock_text(largest.seconds));
  for (const LeftOut& left : sweep.plan.left_out) print(out, "  left out: {}: {}\n", left.what, left.reason);
}

} // namespace springproof::compare
