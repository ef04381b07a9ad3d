#include "compare/write/write_landmarks.hpp"

#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/write/csv.hpp"
#include "compare/write/json.hpp"

#include <fmt/format.h>

namespace springproof::compare {

namespace {

std::string millimetres(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

} // namespace

void write_landmarks_text(std::ostream& out, const Comparison& comparison) {
  if (comparison.landmarks.empty()) return;
  print(out, "  {:<24} {:>14} {:>14} {:>6} {:>14}\n", "landmark, mm", "springs to fem", "deviation", "rays",
        "fem moved");
  for (const LandmarkDistance& landmark : comparison.landmarks)
    if (landmark.missing.empty())
      print(out, "  {:<24} {:>14} {:>14} {:>6} {:>14}\n", landmark.name, millimetres(landmark.mean),
            millimetres(landmark.deviation), landmark.n_rays, millimetres(landmark.moved));
    else
      print(out, "  {:<24} {}\n", landmark.name, landmark.missing);
}

nlohmann::ordered_json landmarks_to_json(const Comparison& comparison) {
  auto list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < comparison.landmarks.size(); ++i) {
    const LandmarkDistance& landmark = comparison.landmarks[i];
    const Eigen::Vector3d& point = comparison.scene.definition.landmarks[i].point;
    list.push_back({{"name", landmark.name},
                    {"point", {point.x(), point.y(), point.z()}},
                    {"from_point", landmark.from_point},
                    {"n_rays", landmark.n_rays},
                    {"mean", landmark.mean},
                    {"deviation", landmark.deviation},
                    {"moved", landmark.moved},
                    {"reason", landmark.missing}});
  }
  return list;
}

void write_landmarks_csv(std::ostream& out, const Comparison& comparison) {
  CsvWriter csv(out, 10);
  csv.row("case", "landmark", "x", "y", "z", "from_point", "n_rays", "mean", "deviation", "moved");
  for (std::size_t i = 0; i < comparison.landmarks.size(); ++i) {
    const LandmarkDistance& landmark = comparison.landmarks[i];
    const Eigen::Vector3d& point = comparison.scene.definition.landmarks[i].point;
    csv.row(comparison.scene.definition.name, landmark.name, point.x(), point.y(), point.z(),
            landmark.from_point, landmark.n_rays, landmark.mean, landmark.deviation, landmark.moved);
  }
}

void write_landmarks(const std::string& folder, const Comparison& comparison) {
  if (comparison.landmarks.empty()) return;
  write_file(folder + "/" + comparison.scene.definition.name + "_landmarks.csv",
             [&](std::ostream& out) { write_landmarks_csv(out, comparison); });
}

} // namespace springproof::compare
