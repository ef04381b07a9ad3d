#include "compare/report/pages.hpp"

#include "cases/case/installation.hpp"
#include "cases/case/names.hpp"
#include "compare/cube/write_design.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/study/write_study.hpp"
#include "compare/table/json.hpp"
#include "compare/write/quote.hpp"
#include "compare/write/write.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

std::string page_file(const std::string& name) {
  return read_file(cases::data_folder("report") + "/" + name);
}

/// A picture as an address, in two thirds of the length that base64 would have.
std::string address_of(const std::string& svg) {
  return "data:image/svg+xml," +
         escaped(svg, {{'%', "%25"}, {'#', "%23"}, {'"', "%22"}, {'<', "%3C"}, {'>', "%3E"}, {'\n', " "}});
}

/// A motion with at most so many times: a screen shows no more.
void thin(Json& motion) {
  constexpr std::size_t most = 2000;
  const std::size_t every = (motion["time"].size() + most - 1) / most;
  motion["drawn_every"] = every;
  if (every <= 1) return;
  const auto thin_out = [&](Json& values) {
    Json kept = Json::array();
    for (std::size_t i = 0; i < values.size(); i += every) kept.push_back(values[i]);
    values = kept;
  };
  thin_out(motion["time"]);
  for (Json& measure : motion["measures"]) {
    thin_out(measure["fem"]);
    thin_out(measure["msm"]);
  }
}

} // namespace

std::string filled_page(const std::string& data, const std::map<std::string, std::string>& values) {
  const auto file = [&](const std::string& name) {
    const std::string own = cases::data_folder(data) + "/" + name;
    return read_file(std::filesystem::exists(own) ? own : cases::data_folder("scripts") + "/" + name);
  };
  const std::string text = file("page.html");
  std::string result;
  std::size_t from = 0;
  for (std::size_t open = text.find("{{"); open != std::string::npos; open = text.find("{{", from)) {
    const std::size_t close = text.find("}}", open);
    const std::string name = text.substr(open + 2, close - open - 2);
    const auto value = values.find(name);
    result += text.substr(from, open - from) + (value == values.end() ? file(name) : value->second);
    from = close + 2;
  }
  return result + text.substr(from);
}

std::string embedded(const Json& document) {
  return escaped(document.dump(-1, ' ', true, Json::error_handler_t::replace), {{'<', "\\u003c"}});
}

std::string picture(const std::string& folder, const std::string& name, const std::string& caption) {
  return fmt::format("<figure id=\"picture-{}\"><img src=\"{}\" alt=\"{}\"></figure>\n", escape(name),
                     escape(address_of(read_file(folder + "/" + name + ".svg"))), escape(caption));
}

void write_page(const std::string& file, const std::string& title, Json data, const std::string& pictures) {
  data["provenance"] = provenance();
  data["licences"] = {page_file("three_licence.txt"), page_file("chart_licence.txt")};
  const std::string page =
      filled_page("report", {{"title", escape(title)}, {"pictures", pictures}, {"data", embedded(data)}});
  write_file(file, [&](std::ostream& out) { out << page; });
}

Json case_page_to_json(const Comparison& comparison, const Ranking* ranking,
                       const std::vector<std::string>& commands, const ErrorBudgets* budgets) {
  const cases::Case& definition = comparison.scene.definition;
  const cases::Fem& fem = comparison.answers.resolved;
  Json document{{"heading", definition.name},
                {"subheading", definition.description},
                {"verdict", verdict_of(comparison)},
                {"time", time_of(comparison)},
                {"is_sound", comparison.is_sound()},
                {"case", case_to_json(comparison)},
                {"springs", springs_of_case(comparison)},
                {"times", Json::array()},
                {"commands", commands}};
  document["case"]["formulation"] =
      fmt::format("{} {}", cases::name_of(fem.formulation), cases::name_of(fem.element));
  document["case"]["design"] = cases::name_of(definition.msm.design);
  if (document["case"].contains("motion") && !document["case"]["motion"].is_null())
    thin(document["case"]["motion"]);
  // The measures stand in a table of their own.
  const auto& motion = definition.dynamics;
  BodyView view = view_of(
      comparison, "case",
      overlay_of(comparison, definition.name + (motion ? fmt::format(", at {:.6g} s", motion->end) : "")));
  view.measures.clear();
  view.description.clear();
  if (Json skin = skin_to_json(comparison); !skin.is_null())
    document["skin"] = std::move(skin); // in place of the cells that it hides
  else
    document["views"] = views_to_json({view});
  if (ranking) document["ranking"] = ranking_to_json(*ranking);
  if (budgets) document["error_budget"] = error_budgets_to_json(*budgets);
  return document;
}

void write_case_page(const std::string& folder, const Comparison& comparison, const Ranking* ranking,
                     const std::vector<std::string>& commands, const ErrorBudgets* budgets) {
  const std::string& name = comparison.scene.definition.name;
  const std::string drawn =
      name + "_bodies"; // a folder, so that no file that gnuplot names has a case's name
  claim_subfolder(folder, drawn);
  plot_bodies(folder + "/" + drawn, "bodies", {overlay_of(comparison, name)}, 1, 700);
  write_page(folder + "/" + name + ".html", name + ": springs against finite elements",
             case_page_to_json(comparison, ranking, commands, budgets));
}

void write_dossier_page(const std::string& folder, const Json& document,
                        const std::vector<std::string>& commands) {
  std::string names;
  for (const Json& one : document["context"]["cases"])
    names += (names.empty() ? "" : ", ") + one["case"].get<std::string>();
  const Json& question = document["context"]["question"];
  write_page(folder + "/dossier.html", "Dossier: " + names,
             {{"heading", "Dossier: " + names},
              {"subheading",
               question.is_null() ? Json("The question that it is to answer was not said.") : question},
              {"dossier", document},
              {"times", Json::array()},
              {"commands", commands}});
}

} // namespace springproof::compare
