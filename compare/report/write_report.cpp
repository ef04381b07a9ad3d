#include "compare/report/write_report.hpp"

#include "compare/provenance/version.hpp"
#include "compare/report/html.hpp"
#include "compare/report/sections.hpp"
#include "compare/write/whole_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace springproof::compare {

namespace {

struct Section {
  std::string id, heading, content;
};

std::string page_file(const std::string& name) {
  return read_file(SPRINGPROOF_REPORT_DIR "/" + name);
}

/// The static picture of each view, which stays on the page where scripts are off.
void draw_stills(const std::string& folder, const std::vector<BodyView>& views) {
  for (const BodyView& view : views) plot_bodies(folder, view.id, {view.overlay}, 1, 300);
}

std::string page(const std::vector<Section>& sections, const std::vector<BodyView>& views) {
  std::string contents, body;
  for (const auto& [id, heading, content] : sections) {
    if (content.empty()) continue;
    contents += fmt::format("<a href='#{}'>{}</a>\n", id, heading);
    body += fmt::format("<section id='{}'>\n<h2>{}</h2>\n{}</section>\n", id, heading, content);
  }
  return html::fill(page_file("template.html"),
                    {{"style", page_file("report.css")},
                     {"version", html::escape(program_version() + " (" + program_commit() + ")")},
                     {"contents", contents},
                     {"sections", body},
                     {"licence", html::escape(page_file("three_licence.txt"))},
                     {"geometry", views_to_json(views).dump()},
                     {"three", read_file(SPRINGPROOF_THREE_JS)},
                     {"controls", read_file(SPRINGPROOF_ORBIT_CONTROLS_JS)},
                     {"script", page_file("view.js") + page_file("page.js")}});
}

} // namespace

void write_report(const std::string& folder, const ThesisResults& results,
                  const std::vector<Figure>& figures) {
  const std::string pictures = folder + "/figures";
  const std::vector<BodyView> views = body_views(results);
  draw_stills(pictures, views);
  const std::string text =
      page({{"summary", "What is reproduced", html::summary_section(results)},
            {"which-design", "Which design to use", html::advice_section(results)},
            {"tables", "Tables", html::tables_section(results)},
            {"designs", "Other designs", html::designs_section(results)},
            {"volumes", "Volumes", html::volumes_section(results)},
            {"figures", "Figures", html::figures_section(figures, pictures)},
            {"views", "Deformed bodies", html::views_section(results, views, pictures)},
            {"settings", "Settings, versions, machine and times", html::settings_section(results)}},
           views);
  write_file(folder + "/report.html", [&](std::ostream& out) { out << text; });
}

} // namespace springproof::compare
