#include "compare/write/write.hpp"

#include "cases/case/names.hpp"
#include "compare/write/csv.hpp"

namespace springproof::compare {

namespace {

std::optional<double> discretisation_error(const Comparison& comparison, std::size_t measure) {
  return comparison.mesh_study ? comparison.mesh_study->measures[measure].discretisation_error_percent
                               : std::nullopt;
}

} // namespace

void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons) {
  CsvWriter csv(out, 10);
  csv.row("case", "measure", "unit", "fem", "msm", "error_percent", "fem_status", "msm_status",
          "fem_discretisation_error_percent", "peer");
  for (const Comparison& c : comparisons)
    for (std::size_t i = 0; i < c.measures.size(); ++i) {
      const MeasuredValue& m = c.measures[i];
      csv.row(c.scene.definition.name, m.name, m.unit, m.fem, m.msm, m.error_percent,
              cases::name_of(c.answers.fem.solution.status), cases::name_of(c.answers.msm.solution.status),
              discretisation_error(c, i), m.peer);
    }
}

} // namespace springproof::compare
