#include "compare/interact/recording.hpp"

#include "compare/table/table.hpp"

namespace springproof::compare {

void write_recording(std::ostream& out, const Simulation& simulation, double step) {
  CsvWriter csv(out, 17); // doubles come back as they were
  out << recording_header << '\n';
  for (const RecordedPull& pull : simulation.recording()) {
    const Eigen::Vector3d& place = simulation.surface().rest.vertices[cases::index(pull.vertex)];
    csv.row(pull.step, static_cast<double>(pull.step) * step, place.x(), place.y(), place.z(),
            simulation.radius(), pull.force.x(), pull.force.y(), pull.force.z());
  }
}

} // namespace springproof::compare
