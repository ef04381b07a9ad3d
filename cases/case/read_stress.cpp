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
  return *value_of<Outcome>(entry.word(allowed));
}

/// What may be expected of a hard case's models: the table, and what is solved for it.
struct HardModel {
  const char* name;
  Side side;
  std::optional<Design> design;
};
const HardModel models[] = {{"msm", Side::msm, std::nullopt},
                            {"hybrid", Side::msm, Design::hybrid},
                            {"fem", Side::fem, std::nullopt}};

ExpectedOutcome read_expected(Table& table, const HardModel& model) {
  ExpectedOutcome expected{model.name, model.side, model.design, table.required("outcome", read_outcome),
                           {},         {}};
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

/// A table that may be left out.
template<class Reader>
auto read_if_there(Table& table, const std::string& key, const Reader& read) {
  table.know({key.c_str()});
  return table.has(key) ? std::optional(table.section(key, read)) : std::nullopt;
}

void read_start(Table& table, Stress& result) {
  result.start = table.optional("start", read_name<Start>).value_or(Start::rest);
  if (result.start == Start::perturbed) {
    result.amplitude = table.required("amplitude", Number{"a number above 0 (mm)", is_positive});
    result.seed = table.required("seed", WholeNumber{"a whole number from 0", 0, 2147483647});
    return;
  }
  table.refuse_unless(false, {"amplitude", "seed"}, "left out: it belongs to start = \"perturbed\"");
  table.know({"amplitude", "seed"});
}

} // namespace

Stress read_stress(Table& table, Msm& msm) {
  Stress result;
  result.is_heavy = table.optional("heavy", read_truth).value_or(false);
  read_start(table, result);
  const auto stiffness =
      table.optional("stiffness", Numbers{"three finite numbers k_e, k_f, k_d (N/m), of any sign", 3});
  if (stiffness) {
    msm.design = Design::given;
    msm.stiffness = {(*stiffness)[0], (*stiffness)[1], (*stiffness)[2]};
    msm.volume_stiffness = 0;
  }
  result.stiffer = read_if_there(table, "stiffer", read_stiffer);
  result.least_load_steps =
      table.optional("least_load_steps", WholeNumber{"a whole number from 1 to 1000", 1, 1000}).value_or(1);
  result.max_seconds = table.required("max_seconds", Number{"a number above 0", is_positive});
  result.max_iterations = table.required("max_iterations", WholeNumber{"a whole number from 1", 1, 1000000});
  for (const HardModel& model : models)
    if (const auto expected =
            read_if_there(table, model.name, [&](Table& section) { return read_expected(section, model); }))
      result.expected.push_back(*expected);
  if (result.expected.empty())
    table.entry("msm").refuse("a table [stress.msm], [stress.hybrid] or [stress.fem] with an outcome");
  if (stiffness && table.has("hybrid"))
    table.entry("stiffness").refuse("left out beside [stress.hybrid], which designs its own");
  return result;
}

} // namespace springproof::cases
