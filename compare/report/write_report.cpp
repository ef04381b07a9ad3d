#include "compare/report/pages.hpp"

#include "cases/case/names.hpp"
#include "compare/solve/springs.hpp"
#include "compare/table/json.hpp"
#include "compare/thesis/write.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

Json computed_to_json(const ComputedFigure& computed) {
  Json json = SPRINGPROOF_MEMBERS(computed, reference, value, fem, msm, reason);
  json["command"] = computed.trace.command;
  return json;
}

/// The entries of tables.json without what "computed_by" says of every reference.
void add_computed(Json& entries, const ThesisResults& results) {
  for (std::size_t e = 0; e < results.entries.size(); ++e) {
    for (const char* key : {"computed", "difference", "reference", "other", "fem", "msm", "reason", "case",
                            "settings", "command", "other_command"})
      entries[e].erase(key);
    entries[e]["computed_by"] = json_list(results.entries[e].computed, computed_to_json);
  }
}

Json cases_to_json(const ThesisResults& results) {
  Json cases = to_json(results.cases)["cases"];
  for (std::size_t c = 0; c < results.cases.size(); ++c) {
    const cases::Fem& fem = results.cases[c].answers.resolved;
    for (const char* key : {"measures", "expectations", "doubts"}) cases[c].erase(key);
    cases[c]["reference"] =
        fmt::format("{} {}", cases::name_of(fem.formulation), cases::name_of(fem.element));
    cases[c]["case"] = results.volumes[c].trace.case_file;
    cases[c]["command"] = results.volumes[c].trace.command;
  }
  return cases;
}

/// What the page says over bodies of one kind. Given springs were solved with the case file's material, so
/// that the ratio of figure 4.15 does not stand in its scenes.
std::string group_of(const cases::Case& definition) {
  if (definition.name.rfind("bar-", 0) == 0) return "The Ogden bar (figure 5.12)";
  if (const auto* linear = std::get_if<cases::LinearElastic>(&definition.material))
    return fmt::format("The linear elastic cube, nu = {:g}", linear->poissons_ratio);
  return "The Ogden cube (figure 5.9)";
}

std::string title_of(const cases::Case& definition) {
  std::string title = definition.name;
  std::replace(title.begin(), title.end(), '-', ' ');
  return title;
}

/// Views of the cases and of figure 4.15. All bars' springs stand against the finest finite elements.
std::vector<BodyView> body_views(const ThesisResults& results, const std::vector<Figure>& figures) {
  std::vector<BodyView> views;
  const auto add = [&](const Comparison& comparison, const std::string& id, const std::string& group,
                       const std::string& command) {
    const cases::Case& definition = comparison.scene.definition;
    views.push_back(view_of(comparison, id, thesis_overlay(results, comparison, title_of(definition))));
    views.back().group = group;
    views.back().command = command;
  };
  for (std::size_t c = 0; c < results.cases.size(); ++c) {
    const cases::Case& definition = results.cases[c].scene.definition;
    add(results.cases[c], definition.name, group_of(definition), results.volumes[c].trace.command);
  }
  for (const Figure& figure : figures)
    if (figure.name == "figure_4_15")
      for (const Comparison& cube : results.figure_4_15)
        add(cube, figure.name + "-" + cube.scene.definition.name,
            "The linear elastic cube, nu = 0.25 (figure 4.15)", figure.command);
  return views;
}

/// Figures of bodies: thousands of faces, which are on the page as bodies to turn.
bool is_of_bodies(const Figure& figure) {
  return figure.name == "figure_4_15" || figure.name == "figure_5_9" || figure.name == "figure_5_12";
}

Json method_to_json(cases::Design design) {
  const cases::DesignFacts& facts = cases::facts_of(design);
  return {{"name", cases::name_of(design)}, {"what", facts.what}, {"published_in", facts.published_in}};
}

/// {"METHOD": [[nu, k_e, k_f, k_d over E L0, k_v over E, exponents if any], ...]}: the designs of
/// four stiffnesses from the least to the largest Poisson's ratio of the advice, without those refused.
Json designed_to_json(const std::vector<Advice>& advice) {
  Json designed = Json::object();
  if (advice.empty()) return designed;
  const auto [least, largest] =
      std::minmax_element(advice.begin(), advice.end(), [](const Advice& a, const Advice& b) {
        return a.poissons_ratio < b.poissons_ratio;
      });
  const auto hundredths = [](double ratio) { return static_cast<int>(std::lround(100 * ratio)); };
  for (const cases::Design design : msm::methods(cases::LinearElastic{})) {
    if (cases::facts_of(design).cells != cases::DesignCells::four_stiffnesses) continue;
    Json& rows = designed[cases::name_of(design)] = Json::array();
    for (int n = hundredths(least->poissons_ratio); n <= hundredths(largest->poissons_ratio); ++n) {
      cases::Msm options;
      options.design = design;
      const double nu = 0.01 * n;
      try {
        const msm::CellStiffness k = msm::design(design_request(cases::LinearElastic{1, nu}, msm::cube(1),
                                                                options, cases::Element::q1))
                                         .stiffness;
        Json row{nu, k.edge, k.face_diagonal, k.internal_diagonal, k.volume, k.midline};
        if (const auto& p = k.exponents)
          for (const double exponent : p->by_kind) row.push_back(exponent);
        for (Json& value : row) value = std::stod(fmt::format("{:.6g}", value.get<double>()));
        rows.push_back(std::move(row));
      } catch (const cases::InputError&) { // the advice says why
      }
    }
  }
  return designed;
}

} // namespace

Json report_to_json(const ThesisResults& results, const std::vector<Figure>& figures) {
  Json document = results_to_json(results);
  const bool has_advice = !results.advice.empty();
  document["heading"] =
      has_advice ? "Which springs for your material?" : "The thesis's tables, computed again";
  document["subheading"] =
      has_advice ? "Mass-spring models against finite elements: every design's errors on the cube of "
                   "San-Vicente's thesis, and the springs for your own Young's modulus and Poisson's ratio."
                 : "Mass-spring models against finite elements.";
  add_computed(document["entries"], results);
  for (std::size_t a = 0; a < results.advice.size(); ++a)
    document["advice"][a]["seconds"] = {{"fem", results.advice[a].fem_seconds},
                                        {"msm", results.advice[a].msm_seconds}};
  const std::vector<SummaryGroup> groups = summarise(results.entries);
  for (std::size_t g = 0; g < groups.size(); ++g)
    document["summary"]["groups"][g]["command"] = groups[g].command;
  document["sheets"] = json_list(sheets_of(results.entries), [](const Sheet& sheet) -> Json {
    return {{"table", sheet.table}, {"name", name_of(sheet)}, {"subject", subject_of(sheet)}};
  });
  document["figures"] = json_list(
      figures, [](const Figure& f) { return SPRINGPROOF_MEMBERS(f, number, name, caption, command); });
  document["times"] = json_list(
      results.times, [](const PhaseTime& time) { return SPRINGPROOF_MEMBERS(time, phase, seconds); });
  document["methods"] = json_list(msm::methods(cases::LinearElastic{}), method_to_json);
  document["designed"] = designed_to_json(results.advice);
  document["cases"] = cases_to_json(results);
  document["views"] = views_to_json(body_views(results, figures));
  document["workers"] = results.workers;
  return document;
}

void write_report(const std::string& folder, const ThesisResults& results,
                  const std::vector<Figure>& figures) {
  std::string pictures;
  for (const Figure& f : figures)
    if (!is_of_bodies(f))
      pictures += picture(folder + "/figures", f.name, "Figure " + f.number + ". " + f.caption);
  write_page(folder + "/report.html", "springproof: which springs for a material, how wrong, how fast",
             report_to_json(results, figures), pictures);
}

} // namespace springproof::compare
