#include "compare/provenance/whole_file.hpp"
#include "compare/thesis/write.hpp"
#include "compare/write/write.hpp"

#include <nlohmann/json.hpp>

namespace springproof::compare {

void write_thesis_files(const std::string& folder, const ThesisResults& results) {
  const auto file = [&](const std::string& name, const std::function<void(std::ostream&)>& write) {
    write_file(folder + "/" + name, write);
  };
  file("tables.txt", [&](std::ostream& out) { write_tables_text(out, results, Commands::one_per_table); });
  file("tables.csv", [&](std::ostream& out) { write_tables_csv(out, results.entries); });
  file("tables.json", [&](std::ostream& out) { out << results_to_json(results).dump(2) << '\n'; });
  if (!results.designs.empty())
    file("designs.csv", [&](std::ostream& out) { write_designs_csv(out, results.designs); });
  if (!results.advice.empty())
    file("advice.csv", [&](std::ostream& out) { write_advice_csv(out, results.advice); });
  if (results.cases.empty()) return;
  file("volumes.csv", [&](std::ostream& out) { write_volumes_csv(out, results.cases); });
  file("box_plot.csv", [&](std::ostream& out) { write_box_plot_csv(out, results.volumes); });
  for (const Comparison& comparison : results.cases)
    file(comparison.scene.definition.name + ".vtu", [&](std::ostream& out) { write_vtu(out, comparison); });
}

} // namespace springproof::compare
