#include "compare/write/write.hpp"

#include "cases/case/names.hpp"
#include "compare/write/csv.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

std::optional<double> discretisation_error(const Comparison& comparison, std::size_t measure) {
  return comparison.mesh_study ? comparison.mesh_study->measures[measure].discretisation_error_percent
                               : std::nullopt;
}

} // namespace

void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons) {
  fmt::print(out, "case,measure,unit,fem,msm,error_percent,fem_status,msm_status,fem_discretisation_error_"
                  "percent,peer\n");
  for (const Comparison& c : comparisons)
    for (std::size_t i = 0; i < c.measures.size(); ++i) {
      const MeasuredValue& m = c.measures[i];
      fmt::print(out, "{},{},{},{},{},{},{},{},{},{}\n", csv_text(c.scene.definition.name), csv_text(m.name),
                 m.unit, csv_number(m.fem), csv_number(m.msm), csv_number(m.error_percent),
                 cases::name_of(c.answers.fem.solution.status), cases::name_of(c.answers.msm.solution.status),
                 csv_number(discretisation_error(c, i)), csv_number(m.peer));
    }
}

} // namespace springproof::compare
