#include "compare/write/write.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write_landmarks.hpp"
#include "compare/write/write_motion.hpp"

namespace springproof::compare {

void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons) {
  CsvWriter csv(out, 10);
  csv.row("case", "measure", "unit", "fem", "msm", "error_percent", "fem_status", "msm_status",
          "fem_discretisation_error_percent", "peer", "reference", "fem_limit", "fem_limit_uncertainty",
          "error_uncertainty_percent", "error_same_mesh_percent");
  for (const auto& [scene, answers, measures, gates, study, landmarks, surface] : comparisons)
    for (const MeasuredValue& m : measures) {
      const std::optional<Limit>& limit = m.fem_limit;
      const StudiedMeasure* studied = study ? find_named(study->measures, m.name) : nullptr;
      csv.row(scene.definition.name, m.name, m.unit, m.fem, m.msm, m.error_percent,
              cases::name_of(answers.fem.solution.status), status_of(answers.msm.solution),
              studied ? studied->discretisation_error_percent : std::nullopt, m.peer,
              m.fem_limit ? "limit" : "same_mesh", limit ? std::optional(limit->value) : std::nullopt,
              limit ? std::optional(limit->uncertainty) : std::nullopt, m.error_uncertainty_percent,
              m.error_same_mesh_percent);
    }
}

void write_results(const std::string& folder, const std::vector<Comparison>& done) {
  write_fields(folder, done.back());
  if (mpi_rank() != 0) return;
  write_motion(folder, done.back());
  write_landmarks(folder, done.back());
  write_file(folder + "/comparison.csv", [&](std::ostream& out) { write_csv(out, done); });
  write_file(folder + "/results.json", [&](std::ostream& out) { out << json_text(to_json(done)); });
}

} // namespace springproof::compare
