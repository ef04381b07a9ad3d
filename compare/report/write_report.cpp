#include "compare/report/write_report.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/thesis/write_files.hpp"
#include "compare/thesis/write_text.hpp"
#include "compare/write/escape.hpp"
#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <openssl/evp.h>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

constexpr double unit_mm = 1e-4;

void append(std::vector<long>& flat, const Eigen::Vector3d& point) {
  for (const double coordinate : point) flat.push_back(std::lround(coordinate / unit_mm));
}

/// The part of a mesh that can be seen.
struct Surface {
  std::vector<std::size_t> nodes; ///< of the mesh, in the surface's order
  std::vector<long> rest, faces;
  bool operator==(const Surface& other) const { return rest == other.rest && faces == other.faces; }
};

Surface surface_of(const cases::HexMesh& mesh) {
  Surface surface;
  std::vector<long> number(mesh.nodes.size(), -1);
  for (const std::array<int, 4>& face : cases::boundary_faces(mesh))
    for (const int vertex : face) {
      const auto node = static_cast<std::size_t>(vertex);
      if (number[node] < 0) {
        number[node] = static_cast<long>(surface.nodes.size());
        surface.nodes.push_back(node);
        append(surface.rest, mesh.nodes[node]);
      }
      surface.faces.push_back(number[node]);
    }
  return surface;
}

Json side_to_json(const DeformedBody& body, std::vector<Surface>& bodies) {
  Surface surface = surface_of(*body.mesh);
  std::vector<long> displacement;
  for (const std::size_t node : surface.nodes) append(displacement, (*body.displacement)[node]);
  const auto known = std::find(bodies.begin(), bodies.end(), surface);
  const auto index = known - bodies.begin();
  if (known == bodies.end()) bodies.push_back(std::move(surface));
  return {{"body", index}, {"displacement", displacement}};
}

/// How far the slider reaches: small displacements may be drawn tenfold, large ones twofold.
double largest_scale(const Overlay& overlay) {
  double largest = 0;
  for (const DeformedBody* body : {&overlay.fem, &overlay.springs})
    for (const Eigen::Vector3d& u : *body->displacement) largest = std::max(largest, u.norm());
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : overlay.fem.mesh->nodes) box.extend(x);
  return largest > 0 ? std::clamp(std::round(0.5 * box.sizes().maxCoeff() / largest), 2.0, 10.0) : 2.0;
}

std::string base64(const std::string& bytes) {
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                  reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  return text; // the null that OpenSSL writes behind it is where the text has its own
}

/// A drawn picture, which is shown where scripts are off and taken to its place by the page's script
/// elsewhere.
std::string picture(const std::string& folder, const std::string& name, const std::string& kind,
                    const std::string& caption) {
  // Thousands of faces make a vector picture larger than its pixels.
  const std::string svg = read_file(folder + "/" + name + ".svg");
  const bool is_small = kind == "figure" && svg.size() < 150'000;
  return fmt::format("<figure class=\"{}\" id=\"picture-{}\"><img src=\"data:image/{};base64,{}\" "
                     "alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
                     kind, escape(name), is_small ? "svg+xml" : "png",
                     base64(is_small ? svg : read_file(folder + "/" + name + ".png")), escape(name),
                     escape(caption));
}

Json trace_to_json(const Trace& trace) {
  return {{"case", trace.case_file}, {"settings", trace.settings}, {"command", trace.command}};
}

Json computed_to_json(const std::vector<ComputedFigure>& computed) {
  Json list = Json::array();
  for (const ComputedFigure& c : computed) {
    list.push_back({{"reference", c.reference},
                    {"value", c.value},
                    {"fem", c.fem},
                    {"msm", c.msm},
                    {"reason", c.reason}});
    list.back().update(trace_to_json(c.trace));
  }
  return list;
}

Json cases_to_json(const ThesisResults& results) {
  Json cases = to_json(results.cases)["cases"];
  for (std::size_t c = 0; c < results.cases.size(); ++c) {
    const cases::Fem& fem = results.cases[c].answers.resolved;
    cases[c]["reference"] =
        fmt::format("{} {}", cases::name_of(fem.formulation), cases::name_of(fem.element));
    cases[c].update(trace_to_json(results.volumes[c].trace));
  }
  return cases;
}

std::string page_file(const std::string& name) {
  return read_file(SPRINGPROOF_REPORT_DIR "/" + name);
}

/// page.html with every {{name}} replaced: by its value, or else by the file of that name.
std::string fill_page(const std::map<std::string, std::string>& values) {
  const std::string text = page_file("page.html");
  std::string result;
  std::size_t from = 0;
  for (std::size_t open = text.find("{{"); open != std::string::npos; open = text.find("{{", from)) {
    const std::size_t close = text.find("}}", open);
    const std::string name = text.substr(open + 2, close - open - 2);
    const auto value = values.find(name);
    result += text.substr(from, open - from) + (value == values.end() ? page_file(name) : value->second);
    from = close + 2;
  }
  return result + text.substr(from);
}

/// One view for each case, in their order. The bars' springs all stand against the finest bar's finite
/// elements.
std::vector<BodyView> body_views(const ThesisResults& results) {
  std::vector<BodyView> views;
  for (const Comparison& comparison : results.cases)
    views.push_back({comparison.scene.definition.name, thesis_overlay(results, comparison, "")});
  return views;
}

} // namespace

Json views_to_json(const std::vector<BodyView>& views) {
  std::vector<Surface> surfaces;
  Json list = Json::array(), bodies = Json::array();
  for (const BodyView& view : views) {
    Json entry{{"id", view.id}, {"largest_scale", largest_scale(view.overlay)}};
    if (view.overlay.fem.is_there()) entry["fem"] = side_to_json(view.overlay.fem, surfaces);
    if (view.overlay.springs.is_there()) entry["springs"] = side_to_json(view.overlay.springs, surfaces);
    list.push_back(std::move(entry));
  }
  for (const Surface& surface : surfaces)
    bodies.push_back({{"rest", surface.rest}, {"faces", surface.faces}});
  return {{"unit_mm", unit_mm}, {"bodies", bodies}, {"views", list}};
}

Json report_to_json(const ThesisResults& results, const std::vector<Figure>& figures) {
  Json document = results_to_json(results);
  for (std::size_t e = 0; e < results.entries.size(); ++e)
    document["entries"][e]["computed_by"] = computed_to_json(results.entries[e].computed);
  const std::vector<SummaryGroup> groups = summarise(results.entries);
  for (std::size_t g = 0; g < groups.size(); ++g)
    document["summary"]["groups"][g]["command"] = groups[g].trace.command;
  for (const char* list : {"sheets", "figures", "times"}) document[list] = Json::array();
  for (const Sheet& sheet : sheets_of(results.entries))
    document["sheets"].push_back(
        {{"table", sheet.table}, {"name", name_of(sheet)}, {"subject", subject_of(sheet)}});
  for (const Figure& f : figures)
    document["figures"].push_back(
        {{"number", f.number}, {"name", f.name}, {"caption", f.caption}, {"command", f.command}});
  for (const PhaseTime& time : results.times)
    document["times"].push_back({{"phase", time.phase}, {"seconds", time.seconds}});
  document["cases"] = cases_to_json(results);
  document["views"] = views_to_json(body_views(results));
  document["provenance"] = provenance();
  document["workers"] = results.workers;
  document["licence"] = page_file("three_licence.txt");
  return document;
}

std::string embedded(const Json& document) {
  std::string result;
  for (const char c : document.dump(-1, ' ', true, Json::error_handler_t::replace))
    result += c == '<' ? "\\u003c" : std::string(1, c);
  return result;
}

void write_report(const std::string& folder, const ThesisResults& results,
                  const std::vector<Figure>& figures) {
  const std::string drawn = folder + "/figures";
  std::string pictures;
  for (const BodyView& view : body_views(results)) {
    plot_bodies(drawn, view.id, {view.overlay}, 1, 300);
    pictures += picture(drawn, view.id, "view", view.id + ": springs over finite elements");
  }
  for (const Figure& f : figures)
    pictures += picture(drawn, f.name, "figure", "Figure " + f.number + ". " + f.caption);
  const std::string page = fill_page({{"pictures", pictures},
                                      {"data", embedded(report_to_json(results, figures))},
                                      {"three", read_file(SPRINGPROOF_THREE_JS)},
                                      {"controls", read_file(SPRINGPROOF_ORBIT_CONTROLS_JS)}});
  write_file(folder + "/report.html", [&](std::ostream& out) { out << page; });
}

} // namespace springproof::compare
