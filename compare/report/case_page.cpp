#include "compare/report/case_page.hpp"

#include "cases/case/names.hpp"
#include "compare/report/bodies.hpp"
#include "compare/report/page.hpp"
#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

#include <fmt/format.h>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

Json case_page_to_json(const Comparison& comparison, const Ranking* ranking,
                       const std::vector<std::string>& commands) {
  const cases::Case& definition = comparison.scene.definition;
  const cases::Fem& fem = comparison.answers.resolved;
  Json document{{"heading", definition.name},
                {"subheading", definition.description},
                {"verdict", verdict_of(comparison)},
                {"is_sound", comparison.is_sound()},
                {"case", case_to_json(comparison)},
                {"times", Json::array()},
                {"commands", commands}};
  document["case"]["formulation"] =
      fmt::format("{} {}", cases::name_of(fem.formulation), cases::name_of(fem.element));
  document["case"]["design"] = cases::name_of(definition.msm.design);
  // The measures stand in a table of their own.
  BodyView view = view_of(comparison, "case", overlay_of(comparison, definition.name));
  view.measures.clear();
  view.description.clear();
  document["views"] = views_to_json({view});
  if (ranking) document["ranking"] = ranking_to_json(*ranking);
  return document;
}

void write_case_page(const std::string& folder, const Comparison& comparison, const Ranking* ranking,
                     const std::vector<std::string>& commands) {
  const std::string& name = comparison.scene.definition.name;
  plot_bodies(folder, name + "_bodies", {overlay_of(comparison, name)}, 1, 700);
  write_page(folder + "/" + name + ".html", name + ": springs against finite elements",
             case_page_to_json(comparison, ranking, commands));
}

} // namespace springproof::compare
