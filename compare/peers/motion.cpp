#include "compare/peers/motion.hpp"

#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "cases/mesh/confined.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/json.hpp"

#include <algorithm>
#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <sstream>

namespace springproof::compare {

namespace fs = std::filesystem;
using Eigen::Vector3d;

namespace {

double volume_of(const cases::Mesh& mesh, const std::vector<Vector3d>& displacement) {
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    volume += cases::cell_volume(cases::cell_corners(mesh, c, displacement));
  return volume;
}

[[noreturn]] void refuse_motion(const std::string& where, const std::string& problem) {
  throw cases::InputError(where + ": " + problem);
}

/// The path of a file that another file names.
std::string named_file(const std::string& folder, const std::string& name, const std::string& where) {
  std::error_code unknown;
  const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, unknown),
                 file = fs::weakly_canonical(root / name, unknown);
  const std::string shown = one_line(name);
  if (fs::path(name).is_absolute() ||
      std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first != root.end())
    refuse_motion(where,
                  fmt::format("names the file '{}', must name files in its own folder or below", shown));
  if (!fs::is_regular_file(file, unknown))
    refuse_motion(where, fmt::format("names the file '{}', which is not there", shown));
  return (fs::path(folder) / name).string();
}

double time_in(const std::string_view text, const std::string& where) {
  const auto time = cases::number_in<double>(text);
  if (!time)
    refuse_motion(where,
                  fmt::format("time is '{}', must be a finite number (s)", one_line(std::string(text))));
  return *time;
}

/// One body, read from a file of its own when it is asked for.
GivenBody body_in(const std::string& file, double time, const std::string& array) {
  return {time, file, [=] { return read_displacements(file, array); }};
}

/// A list of "timestep", "file" and "part". Confined, for the parser calls itself at every tag in a tag.
Json data_sets_in(const std::string& path) try {
  const std::string text = cases::read_text_file(path);
  const std::string list = cases::run_confined(
      [&] {
        boost::property_tree::ptree tree;
        std::istringstream in(text);
        read_xml(in, tree);
        Json sets = Json::array();
        for (const auto& child : tree.get_child("VTKFile.Collection"))
          if (child.first == "DataSet")
            sets.push_back({child.second.get<std::string>("<xmlattr>.timestep"),
                            child.second.get<std::string>("<xmlattr>.file"),
                            child.second.get<std::string>("<xmlattr>.part", "0")});
        return sets.dump();
      },
      cases::limits_to_read(text.size()));
  return Json::parse(list);
} catch (const cases::InputError&) {
  throw;
} catch (const std::exception& error) {
  refuse_motion(path, std::string("is no .pvd file that can be read: ") + one_line(error.what()));
}

std::vector<GivenBody> read_pvd(const std::string& path, const std::string& array) {
  std::vector<GivenBody> bodies;
  for (const Json& set : data_sets_in(path)) {
    const std::string where = fmt::format("{}: DataSet {}", path, bodies.size() + 1);
    if (set[2] != "0") refuse_motion(where, "is part of a body, must be a whole one: one file for each time");
    bodies.push_back(body_in(named_file(fs::path(path).parent_path(), set[1], where),
                             time_in(set[0].get<std::string>(), where), array));
  }
  return bodies;
}

std::vector<GivenBody> read_listed(const std::string& folder, const std::string& list,
                                   const std::string& array) {
  std::vector<GivenBody> bodies;
  const auto check_heading = [](const cases::TextRow& row) {
    if (row.line != "file,time") throw cases::InputError(row.place() + "must be the header file,time");
  };
  const bool has_heading =
      cases::read_rows(cases::read_text_file(list), list, cases::Between::commas, check_heading,
                       [&](const cases::TextRow& row) {
                         const std::string where = fmt::format("{}:{}", list, row.number);
                         if (row.fields.size() != 2)
                           refuse_motion(where, "must be a file and its time (s) between a comma");
                         bodies.push_back(body_in(named_file(folder, std::string(row.fields[0]), where),
                                                  time_in(row.fields[1], where), array));
                       });
  if (!has_heading) refuse_motion(list + ":1", "must be the header file,time");
  return bodies;
}

std::vector<GivenBody> read_numbered(const std::string& folder, double step, const std::string& array) {
  std::map<int, std::string> files;
  std::string pattern;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename(), stem = entry.path().stem();
    const std::size_t end = stem.find_last_not_of("0123456789") + 1; // npos + 1 is 0
    const auto number = cases::number_in<int>(stem.substr(end));
    if (!number || !entry.is_regular_file()) continue;
    const std::string its = stem.substr(0, end) + "*" + entry.path().extension().string();
    if (!pattern.empty() && pattern != its)
      refuse_motion(folder,
                    fmt::format("has files {} and {}, must have numbered files of one name, or a times.csv "
                                "(file,time)",
                                one_line(std::min(pattern, its)), one_line(std::max(pattern, its))));
    pattern = its;
    if (const auto [known, is_new] = files.insert({*number, entry.path()}); !is_new)
      refuse_motion(folder, fmt::format("has two files of number {}: {} is one", *number, one_line(name)));
  }
  std::vector<GivenBody> bodies;
  for (const auto& file : files) bodies.push_back(body_in(file.second, file.first * step, array));
  return bodies;
}

std::vector<GivenBody> read_folder(const std::string& folder, double step, const std::string& array) try {
  const std::string list = fs::path(folder) / "times.csv";
  return fs::exists(list) ? read_listed(folder, list, array) : read_numbered(folder, step, array);
} catch (const fs::filesystem_error& error) {
  refuse_motion(folder, error.code().message());
}

std::vector<GivenBody> read_motion_csv(const std::string& path) {
  std::vector<GivenBody> bodies;
  std::vector<std::shared_ptr<std::vector<GivenDisplacement>>> nodes;
  read_displacement_rows(cases::read_text_file(path), path, "time,x,y,z,ux,uy,uz",
                         [&](const std::vector<double>& v, const std::string& where) {
                           if (bodies.empty() || v[0] != bodies.back().time) {
                             nodes.push_back(std::make_shared<std::vector<GivenDisplacement>>());
                             bodies.push_back({v[0], where, [its = nodes.back()] { return *its; }});
                           }
                           nodes.back()->push_back({{v[1], v[2], v[3]}, {v[4], v[5], v[6]}, where});
                         });
  return bodies;
}

/// The body nearest to a time, if that is the same time: six digits of text are off by five millionths. Where
/// that is much of a step, they do not tell one step's body from the next one's.
const GivenBody* body_at(const std::vector<GivenBody>& bodies, double time, double step) {
  const auto later = std::lower_bound(bodies.begin(), bodies.end(), time,
                                      [](const GivenBody& body, double t) { return body.time < t; });
  const GivenBody* nearest = nullptr;
  double distance = std::min(5e-6 * time + 1e-6 * step, step / 4);
  for (auto at = later == bodies.begin() ? later : later - 1; at != bodies.end() && at <= later; ++at)
    if (std::abs(at->time - time) <= distance) {
      distance = std::abs(at->time - time);
      nearest = &*at;
    }
  return nearest;
}

} // namespace

std::vector<double> frame_times(const cases::Scene& scene) {
  std::vector<double> times;
  if (const auto& dynamics = scene.definition.dynamics)
    for (int step = 0; step <= dynamics->n_steps(); ++step) times.push_back(step * dynamics->step);
  return times;
}

void record_motion(const cases::Scene& scene, cases::Solution& solution,
                   const std::function<std::vector<Vector3d>(std::size_t, double)>& body) {
  const std::vector<double> times = frame_times(scene);
  const bool has_volume = cases::watches_volume(scene);
  cases::Trajectory motion;
  motion.nodes = cases::watched_nodes(scene);
  for (std::size_t k = 0; k < times.size(); ++k) {
    std::vector<Vector3d> at = body(k, times[k]);
    motion.time.push_back(times[k]);
    for (const int node : motion.nodes) motion.displacement.push_back(at[cases::index(node)]);
    if (has_volume) motion.volume.push_back(volume_of(scene.mesh, at));
    const int step = static_cast<int>(k);
    if (step % scene.definition.dynamics->write_every == 0 || k + 1 == times.size())
      motion.bodies.push_back({step, at});
    solution.displacement = std::move(at);
  }
  solution.trajectory = std::move(motion);
}

std::vector<GivenBody> read_motion(const std::string& path, double step, const std::string& array) {
  if (one_line(path) != path)
    throw cases::InputError(one_line(path) + ": the name must be one line of UTF-8 text");
  std::error_code unknown;
  const std::string ending = fs::path(path).extension();
  const bool is_folder = fs::is_directory(path, unknown);
  if (!is_folder && ending != ".pvd" && ending != ".csv")
    refuse_motion(
        path, "is of one time, and this case has [dynamics]: give a .pvd, a folder of numbered files, or a "
              ".csv (time,x,y,z,ux,uy,uz)");
  if (ending == ".csv" && !array.empty()) refuse_array(path);
  std::vector<GivenBody> bodies = is_folder          ? read_folder(path, step, array)
                                  : ending == ".pvd" ? read_pvd(path, array)
                                                     : read_motion_csv(path);
  if (bodies.empty()) refuse_motion(path, "has no times, must have one body for each time of the motion");
  for (std::size_t b = 1; b < bodies.size(); ++b)
    if (!(bodies[b].time > bodies[b - 1].time))
      refuse_motion(bodies[b].where,
                    fmt::format("has the time {:g} s after {:g} s; times must ascend, with one body "
                                "for each",
                                bodies[b].time, bodies[b - 1].time));
  return bodies;
}

cases::Solution motion_from(const cases::Scene& scene, const std::string& path, const std::string& array) {
  const double step = scene.definition.dynamics->step;
  const std::vector<GivenBody> bodies = read_motion(path, step, array);
  std::vector<const GivenBody*> used;
  const std::vector<double> times = frame_times(scene);
  for (const double time : times) {
    used.push_back(body_at(bodies, time, step));
    if (!used.back())
      refuse_motion(
          path, fmt::format("has no body at {:g} s, must have one at each of the case's {} times, 0 to {:g} "
                            "s by {:g} s; it has {} from {:g} to {:g} s. Write every step, or change "
                            "dynamics.step and dynamics.end",
                            time, times.size(), times.back(), step, bodies.size(), bodies.front().time,
                            bodies.back().time));
  }
  cases::Solution solution;
  record_motion(scene, solution, [&](std::size_t k, double) {
    return match_nodes(scene.mesh, used[k]->nodes(), used[k]->where);
  });
  return solution;
}

} // namespace springproof::compare
