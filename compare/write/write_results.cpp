#include "compare/write/write_results.hpp"

#include "compare/provenance/whole_file.hpp"
#include "compare/write/write.hpp"

#include <nlohmann/json.hpp>

namespace springproof::compare {

void write_results(const std::string& folder, const std::vector<Comparison>& done) {
  const Comparison& last = done.back();
  write_file(folder + "/" + last.scene.definition.name + ".vtu",
             [&](std::ostream& out) { write_vtu(out, last); });
  write_file(folder + "/comparison.csv", [&](std::ostream& out) { write_csv(out, done); });
  write_file(folder + "/results.json", [&](std::ostream& out) { out << to_json(done).dump(2) << '\n'; });
}

} // namespace springproof::compare
