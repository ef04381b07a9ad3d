#include "compare/write.hpp"

#include "cases/names.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace compare {

void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons) {
  const auto field = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.10g}", *value) : "";
  };
  fmt::print(out, "case,measure,unit,fem,msm,error_percent,fem_status,msm_status\n");
  for (const Comparison& c : comparisons)
    for (const MeasuredValue& m : c.measures)
      fmt::print(out, "{},{},{},{},{},{},{},{}\n", c.scene.definition.name, m.name, m.unit, field(m.fem),
                 field(m.msm), field(m.error_percent), cases::name_of(c.fem.solution.status),
                 cases::name_of(c.msm.solution.status));
}

} // namespace compare
