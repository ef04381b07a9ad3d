#include "cases/case/read_stress.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::cases {

namespace {

Stiffer read_stiffer(Table& table) {
  return {table.required("axis", read_name<Axis>), table.required("beyond", Number{"a finite number (mm)"}),
          table.required("factor", Number{"a number above 0", is_positive})};
}

Outcome read_outcome(const Entry& entry) {
  std::vector<std::string> allowed = all_names<Outcome>();
  allowed.erase(std::remove(allowed.begin(), allowed.end(), name_of(Outcome::unknown)), allowed.end());
  const auto text = entry.node ? entry.node->value_exact<std::string>() : std::nullopt;
  if (!text || std::find(allowed.begin(), allowed.end(), *text) == allowed.end()) entry.refuse_word(allowed);
  return *value_of<Outcome>(*text);
}

ExpectedOutcome read_expected(Table& table, Side side) {
  ExpectedOutcome expected;
  expected.side = side;
  expected.where = table.where();
  expected.outcome = table.required("outcome", read_outcome);
  const std::string allowed = "an interval [lower, upper] with 0 <= lower <= upper <= 1";
  if (const auto interval = table.optional("load_reached", Numbers{allowed, 2})) {
    if (!(0 <= (*interval)[0] && (*interval)[0] <= (*interval)[1] && (*interval)[1] <= 1))
      table.entry("load_reached").refuse(allowed);
    expected.load_reached = {(*interval)[0], (*interval)[1]};
  }
  expected.inverted_cells =
      table.optional("inverted_cells", WholeNumber{"a whole number from 0", 0, 2147483647});
  return expected;
}

void read_start(Table& table, HardCase& result) {
  result.start = table.optional("start", read_name<Start>).value_or(Start::rest);
  const bool is_perturbed = result.start == Start::perturbed;
  for (const char* key : {"amplitude", "seed"})
    if (!is_perturbed && table.has(key))
      table.entry(key).refuse("left out: it belongs to start = \"perturbed\"");
  if (!is_perturbed) {
    table.optional("amplitude", read_text); // known, though absent
    table.optional("seed", read_text);
    return;
  }
  result.amplitude = table.required("amplitude", Number{"a number above 0 (mm)", is_positive});
  result.seed = table.required("seed", WholeNumber{"a whole number from 0", 0, 2147483647});
}

} // namespace

void read_stress(Table& table, HardCase& result) {
  result.is_heavy = table.optional("heavy", read_truth).value_or(false);
  read_start(table, result);
  if (const auto k =
          table.optional("stiffness", Numbers{"three finite numbers k_e, k_f, k_d (N/m), of any sign", 3}))
    result.stiffness = {(*k)[0], (*k)[1], (*k)[2]};
  if (table.has("stiffer")) result.stiffer = table.section("stiffer", read_stiffer);
  table.optional("stiffer", [](const Entry&) { return 0; }); // known, though absent
  result.least_load_steps =
      table.optional("least_load_steps", WholeNumber{"a whole number from 1 to 1000", 1, 1000}).value_or(1);
  result.max_seconds = table.required("max_seconds", Number{"a number above 0", is_positive});
  result.max_iterations = table.required("max_iterations", WholeNumber{"a whole number from 1", 1, 1000000});
  for (const auto& [side, key] : names<Side>()) {
    if (table.has(key))
      result.expected.push_back(
          table.section(key, [side = side](Table& section) { return read_expected(section, side); }));
    table.optional(key, [](const Entry&) { return 0; }); // known, though absent
  }
  if (result.expected.empty())
    table.entry("msm").refuse("a table [stress.msm], [stress.hybrid] or [stress.fem] with an outcome");
  if (result.stiffness)
    for (const ExpectedOutcome& expected : result.expected)
      if (expected.side == Side::hybrid)
        table.entry("stiffness").refuse("left out beside [stress.hybrid], which designs its own");
}

} // namespace springproof::cases
