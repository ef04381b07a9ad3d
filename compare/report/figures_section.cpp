#include "compare/report/html.hpp"
#include "compare/report/sections.hpp"

#include <fmt/format.h>

namespace springproof::compare::html {

namespace {

/// What a view's line of measures says: "alpha_1 23.2 | 21.1 deg, -9.1 %".
std::string measures(const Comparison& comparison) {
  std::string html;
  for (const MeasuredValue& m : comparison.measures)
    html += fmt::format("<br>{}: FEM {}, MSM {} {}{}", escape(m.name), number(m.fem), number(m.msm),
                        escape(m.unit),
                        m.error_percent ? fmt::format(", error {:+.2f} %", *m.error_percent) : "");
  for (const Answer* side : {&comparison.answers.fem, &comparison.answers.msm})
    if (side->solution.status == cases::Status::failed)
      html += "<br>failed: " + escape(side->solution.message);
  return html;
}

} // namespace

std::string figures_section(const std::vector<Figure>& figures, const std::string& folder) {
  std::string html;
  for (const Figure& figure : figures) {
    // Thousands of faces make a vector picture larger than its pixels.
    const std::string drawing = folder + "/" + figure.name;
    const std::string vector = data_address(drawing + ".svg", "image/svg+xml");
    const std::string picture =
        vector.size() < 200'000 ? vector : data_address(drawing + ".png", "image/png");
    html += fmt::format(
        R"(<figure id='{0}'><img src='{1}' alt='Figure {2}'>
<figcaption><b>Figure {2}.</b> {3} <span class='quiet'>Files: figures/{0}.svg, .png, .gp. Again:
<code>{4}</code></span></figcaption></figure>
)",
        figure.name, picture, escape(figure.number), escape(figure.caption), escape(figure.command));
  }
  return html;
}

std::string views_section(const ThesisResults& results, const std::vector<BodyView>& views,
                          const std::string& folder) {
  if (views.empty()) return "";
  std::string html =
      R"(<p>Drag to turn. <span class='fem-key'>Finite elements: blue translucent surface with its
edges.</span> <span class='springs-key'>Springs: orange lines (the surface's edges, and fainter
its diagonals).</span> The slider multiplies the displacements; × 1 is true. Both models on one
mesh for ParaView: CASE.vtu.</p>
<div class='views'>
)";
  for (std::size_t v = 0; v < views.size(); ++v) {
    const cases::Case& definition = results.cases[v].scene.definition;
    html += fmt::format(R"(<figure class='view' id='view-{0}'><img src='{1}' alt='{0}: springs over finite
elements'><canvas></canvas>
<div class='controls'><label>displacements <input type='range' min='0' max='2' step='0.05'
value='1'></label> <output></output><label><input type='checkbox' name='fem' checked> finite
elements</label><label><input type='checkbox' name='springs' checked> springs</label></div>
<figcaption><b>{0}</b><br>{2}.{3}<br><code>{4}</code></figcaption></figure>
)",
                        escape(views[v].id), data_address(folder + "/" + views[v].id + ".png", "image/png"),
                        escape(definition.description), measures(results.cases[v]),
                        escape(results.case_traces[v].command));
  }
  return html + "</div>\n";
}

} // namespace springproof::compare::html
