#include "compare/write/write.hpp"

#include "compare/measure/measure.hpp"
#include "compare/measure/over_time.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"
#include "compare/write/quote.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

using Trajectory = cases::Trajectory;

const Trajectory* trajectory_of(const Answer& answer) {
  const auto& trajectory = answer.solution.trajectory;
  return trajectory ? &*trajectory : nullptr;
}

/// Motion of the finite elements, or else of the springs: both have the times of [dynamics]. Null: neither
/// moved.
const Trajectory* any_trajectory(const Comparison& comparison) {
  const Trajectory* of_fem = trajectory_of(comparison.answers.fem);
  return of_fem ? of_fem : trajectory_of(comparison.answers.msm);
}

/// A measure's course in both models; empty in one that did not move.
struct Courses {
  const cases::Measure& measure;
  std::vector<double> fem, msm;
};

std::vector<Courses> courses_of(const Comparison& comparison) {
  const auto values = [&](const cases::Measure& measure, const Answer& answer) {
    if (!trajectory_of(answer)) return std::vector<double>();
    return series_of(measure, comparison.scene, answer.solution).value;
  };
  std::vector<Courses> all;
  for (const cases::Measure& measure : comparison.scene.definition.measures)
    if (measure.over_time) // norms of fields have none
      all.push_back(
          {measure, values(measure, comparison.answers.fem), values(measure, comparison.answers.msm)});
  return all;
}

/// Unit of the measure's values, whatever number of their course the case asks for.
std::string unit_of_values(cases::Measure measure) {
  measure.over_time.reset();
  return unit_of(measure);
}

std::optional<double> entry_at(const std::vector<double>& values, std::size_t step) {
  return step < values.size() ? std::optional(values[step]) : std::nullopt;
}

struct MotionFiles {
  std::string folder, name;
  std::string series() const { return folder + "/" + name + "_motion.csv"; }
  std::string list() const { return folder + "/" + name + ".pvd"; }
  std::string bodies() const { return name + "_motion"; }
  std::string body(std::size_t i) const { return fmt::format("{}/{}_{:04}.vtu", bodies(), name, i); }
};

/// Bodies of both models at one time.
std::vector<cases::PointField> fields_at(const Comparison& comparison, std::size_t body) {
  std::vector<cases::PointField> fields;
  const auto add = [&](const std::string& name, const Trajectory* trajectory) {
    if (trajectory && body < trajectory->bodies.size())
      fields.push_back({name, trajectory->bodies[body].displacement});
  };
  add("fem_displacement", trajectory_of(comparison.answers.fem));
  add("msm_displacement", trajectory_of(comparison.answers.msm));
  return fields;
}

/// What ParaView opens.
void write_times(std::ostream& out, const MotionFiles& files, const Trajectory& trajectory) {
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n";
  for (std::size_t i = 0; i < trajectory.bodies.size(); ++i)
    out << fmt::format("    <DataSet timestep=\"{}\" file=\"{}\"/>\n",
                       trajectory.time[cases::index(trajectory.bodies[i].step)], escape(files.body(i)));
  out << "  </Collection>\n</VTKFile>\n";
}

/// Nothing where the steps change little.
std::optional<std::string> note_on_slowest(const char* side, const cases::Scene& scene,
                                           const cases::Solution& solution) {
  const auto slowest = slowest_in_steps(scene, solution);
  if (!slowest) return std::nullopt;
  const cases::Scheme scheme = scene.definition.dynamics->scheme.scheme;
  const char* warning = slowest->outlasts_period()
                            ? "; Warning: a step outlasts its period: swings and peaks are lost"
                        : slowest->exceeds_body() ? "; Warning: they damp it more than the body does"
                        : slowest->is_late()      ? "; Warning: its swings come too late"
                                                  : "";
  if (scheme != cases::Scheme::implicit_euler && *warning == '\0') return std::nullopt;
  return fmt::format(
      "{}: slowest vibration of {:.4g} Hz: omega h = {:.3g}, damping ratio {:.3g} of its own and {:.3g} "
      "of {}'s steps, period {:+.3g} %{}",
      side, slowest->vibration.omega / (2 * M_PI), slowest->omega_h(), slowest->vibration.damping_ratio,
      slowest->swings.damping_ratio, cases::name_of(scheme), 100 * (slowest->swings.period - 1), warning);
}

} // namespace

void write_motion_csv(std::ostream& out, const Comparison& comparison) {
  CsvWriter csv(out, 10);
  csv.row("case", "measure", "unit", "time", "fem", "msm");
  const Trajectory* motion = any_trajectory(comparison);
  if (!motion) return;
  for (const auto& [measure, fem, msm] : courses_of(comparison))
    for (std::size_t step = 0; step < motion->time.size(); ++step)
      csv.row(comparison.scene.definition.name, measure.name, unit_of_values(measure), motion->time[step],
              entry_at(fem, step), entry_at(msm, step));
}

Json surface_to_json(const SurfaceMotion& surface) {
  Json document = SPRINGPROOF_MEMBERS(surface, time, fem, msm, difference);
  document.update({{"largest_difference", surface.largest}, {"error_percent", surface.error_percent}});
  return document;
}

Json motion_to_json(const Comparison& comparison) {
  const Trajectory* motion = any_trajectory(comparison);
  if (!motion) return nullptr;
  Json measures = Json::array();
  for (const auto& [measure, fem, msm] : courses_of(comparison))
    measures.push_back(
        {{"name", measure.name}, {"unit", unit_of_values(measure)}, {"fem", fem}, {"msm", msm}});
  Json document{{"notes", notes_on_motion(comparison)}, {"time", motion->time}, {"measures", measures}};
  if (const auto& surface = comparison.surface_motion) document["surface"] = surface_to_json(*surface);
  return document;
}

std::vector<std::string> notes_on_motion(const Comparison& comparison) {
  // Measures that are numbers of one course share a note.
  std::vector<std::pair<std::string, std::vector<std::string>>> found;
  const auto add = [&](const char* side, const Answer& answer, const cases::Measure& measure) {
    const auto damping = numerical_damping(measure, comparison.scene, answer.solution);
    if (!damping) return;
    const std::string note = fmt::format(" of {}: implicit Euler's steps damp its swings of {:.4g} Hz by a "
                                         "ratio of {:.3g}, of {:.3g} in all{}",
                                         side, damping->frequency, damping->ratio, damping->measured,
                                         damping->exceeds_body() ? "; Warning: more than the body does" : "");
    const auto same =
        std::find_if(found.begin(), found.end(), [&](const auto& other) { return other.first == note; });
    if (same == found.end())
      found.push_back({note, {measure.name}});
    else
      same->second.push_back(measure.name);
  };
  for (const cases::Measure& measure : comparison.scene.definition.measures) {
    add("fem", comparison.answers.fem, measure);
    add("msm", comparison.answers.msm, measure);
  }
  std::vector<std::string> notes;
  for (const auto& [side, answer] :
       {std::pair("fem", &comparison.answers.fem), std::pair("msm", &comparison.answers.msm)})
    if (auto note = note_on_slowest(side, comparison.scene, answer->solution))
      notes.push_back(std::move(*note));
  for (const auto& [note, names] : found) notes.push_back(fmt::format("{}{}", fmt::join(names, ", "), note));
  if (const auto& surface = comparison.surface_motion; surface && surface->error_percent)
    notes.push_back(fmt::format("surface: over time the springs' is {:.4g} % of the finite elements' "
                                "displacement from theirs, {:.4g} "
                                "mm at most",
                                *surface->error_percent,
                                *std::max_element(surface->largest.begin(), surface->largest.end())));
  return notes;
}

void write_motion(const std::string& folder, const Comparison& comparison) {
  const Trajectory* motion = any_trajectory(comparison);
  const MotionFiles files{folder, comparison.scene.definition.name};
  remove_numbered(folder + "/" + files.bodies(), files.name,
                  motion ? static_cast<int>(motion->bodies.size()) : 0);
  if (!motion) {
    std::error_code not_there;
    std::filesystem::remove(files.series(), not_there);
    std::filesystem::remove(files.list(), not_there);
    return;
  }
  write_file(files.series(), [&](std::ostream& out) { write_motion_csv(out, comparison); });
  claim_subfolder(folder, files.bodies());
  for (std::size_t i = 0; i < motion->bodies.size(); ++i)
    write_file(folder + "/" + files.body(i),
               [&](std::ostream& out) { write_vtu(out, comparison.scene.mesh, fields_at(comparison, i)); });
  write_file(files.list(), [&](std::ostream& out) { write_times(out, files, *motion); });
}

} // namespace springproof::compare
