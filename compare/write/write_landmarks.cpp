#include "compare/write/write_landmarks.hpp"

#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

std::string millimetres(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

/// Whether the springs' answer is one after a number of iterations: then their equilibrium is another one.
bool has_equilibrium(const Comparison& comparison) {
  const auto& all = comparison.landmarks;
  return std::any_of(all.begin(), all.end(), [](const auto& one) { return one.to_equilibrium; });
}

} // namespace

void write_landmarks_text(std::ostream& out, const Comparison& comparison) {
  if (comparison.landmarks.empty()) return;
  const bool both = has_equilibrium(comparison);
  Columns columns{{"landmark, mm"}};
  columns.insert(columns.end(), {{"springs to fem"}, {"deviation"}, {"rays"}, {"fem moved"}});
  if (both) columns.insert(columns.end(), {{"to their equilibrium"}, {"deviation"}});
  TextTable table(std::move(columns));
  for (const LandmarkDistance& landmark : comparison.landmarks) {
    if (!landmark.missing.empty() && !landmark.to_equilibrium) continue;
    std::vector<std::string> row{landmark.name, millimetres(landmark.to_fem.mean),
                                 millimetres(landmark.to_fem.deviation),
                                 fmt::format("{}", landmark.to_fem.n_rays), millimetres(landmark.moved)};
    if (both) {
      const RayLengths own = landmark.to_equilibrium.value_or(RayLengths{});
      row.insert(row.end(), {millimetres(own.mean), millimetres(own.deviation)});
    }
    table.add(std::move(row));
  }
  table.write(out);
  for (const LandmarkDistance& landmark : comparison.landmarks)
    if (!landmark.missing.empty() && !landmark.to_equilibrium)
      write_wrapped(out, "  " + landmark.name + ": " + landmark.missing, 4);
}

nlohmann::ordered_json landmarks_to_json(const Comparison& comparison) {
  auto list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < comparison.landmarks.size(); ++i) {
    const LandmarkDistance& landmark = comparison.landmarks[i];
    const Eigen::Vector3d& point = comparison.scene.definition.landmarks[i].point;
    nlohmann::ordered_json to_equilibrium;
    if (const auto& own = landmark.to_equilibrium)
      to_equilibrium = {{"n_rays", own->n_rays}, {"mean", own->mean}, {"deviation", own->deviation}};
    list.push_back({{"name", landmark.name},
                    {"point", {point.x(), point.y(), point.z()}},
                    {"from_point", landmark.from_point},
                    {"n_rays", landmark.to_fem.n_rays},
                    {"mean", landmark.to_fem.mean},
                    {"deviation", landmark.to_fem.deviation},
                    {"moved", landmark.moved},
                    {"to_equilibrium", to_equilibrium},
                    {"reason", landmark.missing}});
  }
  return list;
}

void write_landmarks_csv(std::ostream& out, const Comparison& comparison) {
  CsvWriter csv(out, 10);
  csv.row("case", "landmark", "x", "y", "z", "from_point", "n_rays", "mean", "deviation", "moved",
          "to_equilibrium_mean", "to_equilibrium_deviation");
  for (std::size_t i = 0; i < comparison.landmarks.size(); ++i) {
    const LandmarkDistance& landmark = comparison.landmarks[i];
    const Eigen::Vector3d& point = comparison.scene.definition.landmarks[i].point;
    const RayLengths own = landmark.to_equilibrium.value_or(RayLengths{});
    csv.row(comparison.scene.definition.name, landmark.name, point.x(), point.y(), point.z(),
            landmark.from_point, landmark.to_fem.n_rays, landmark.to_fem.mean, landmark.to_fem.deviation,
            landmark.moved, own.mean, own.deviation);
  }
}

void write_landmarks(const std::string& folder, const Comparison& comparison) {
  const std::string file = folder + "/" + comparison.scene.definition.name + "_landmarks.csv";
  std::error_code not_there;
  if (comparison.landmarks.empty())
    std::filesystem::remove(file, not_there); // an earlier run's
  else
    write_file(file, [&](std::ostream& out) { write_landmarks_csv(out, comparison); });
}

} // namespace springproof::compare
