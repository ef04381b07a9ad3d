#include "compare/thesis/write.hpp"

#include "compare/provenance/print.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <fmt/ostream.h>
#include <map>
#include <set>
#include <sstream>

namespace springproof::compare {

namespace {

/// The parts that tell an entry's column from others.
std::array<std::string, 3> column_of(const PublishedFigure& p) {
  return {p.design, fmt::format("nu = {:g}", p.poissons_ratio), p.load_set};
}

using Lines = std::vector<std::string>;

constexpr std::size_t between_tables = 4; ///< characters
constexpr std::size_t half_screen = (screen_width - between_tables) / 2;

Lines lines_in(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool is_of_one_cell(const Sheet& sheet) {
  return sheet.entries.front()->published.test == "cell";
}

std::string unit_text(const Sheet& sheet) {
  const std::string& unit = sheet.entries.front()->published.unit;
  if (is_of_one_cell(sheet)) return subject_of(sheet);
  return unit == "%" ? "errors r, %" : "volumes of the springs' body, " + unit;
}

/// A part of the columns' names if all have the same, else nothing.
std::optional<std::string> common_part(const Sheet& sheet, std::size_t part) {
  const std::string& first = sheet.columns.front()[part];
  for (const auto& column : sheet.columns)
    if (column[part] != first) return std::nullopt;
  return first;
}

/// Designs that were made for another Poisson's ratio than the tissue's: ", linear_method designed for ...".
std::string other_ratios(const Sheet& sheet) {
  std::set<std::string> designs;
  for (const TableEntry* entry : sheet.entries)
    if (const PublishedFigure& p = entry->published; p.design_poissons_ratio != p.poissons_ratio)
      designs.insert(fmt::format(", {} designed for nu = {:g}", p.design, p.design_poissons_ratio));
  return fmt::format("{}", fmt::join(designs, ""));
}

/// Name, quantity, and whatever its columns have in common.
std::string title_of(const Sheet& sheet) {
  std::string title = name_of(sheet) + ": " + unit_text(sheet);
  const bool is_ogden = sheet.entries.front()->published.material == "ogden";
  if (!is_of_one_cell(sheet))
    if (const auto design = common_part(sheet, 0)) title += ", springs by " + *design;
  if (is_ogden)
    title += ", Ogden's material";
  else if (const auto nu = common_part(sheet, 1))
    title += ", " + *nu;
  if (const auto loads = common_part(sheet, 2); loads && !loads->empty()) title += ", " + *loads + " loads";
  return title + other_ratios(sheet);
}

/// What tells a column from the others.
std::string head_of(const Sheet& sheet, const std::array<std::string, 3>& column) {
  std::vector<std::string> parts;
  for (std::size_t part = 0; part < column.size(); ++part)
    if (!common_part(sheet, part)) parts.push_back(column[part]);
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// A row is named by its measure, or by its test where all rows have one measure.
std::string label_of(const Sheet& sheet, const Sheet::Row& row) {
  static const std::map<std::string, std::string> symbols{
      {"edge", "k'_e"}, {"face_diagonal", "k'_f"}, {"internal_diagonal", "k'_d"}, {"beta_1", "beta_1 (!)"}};
  const bool has_one_measure =
      std::all_of(sheet.rows.begin(), sheet.rows.end(),
                  [&](const Sheet::Row& other) { return other.measure == row.measure; });
  if (has_one_measure && sheet.rows.size() > 1) return row.test;
  const auto symbol = symbols.find(row.measure);
  return symbol == symbols.end() ? row.measure : symbol->second;
}

/// A table as it stands on the screen.
struct Layout {
  struct Row {
    std::string label;
    std::vector<const TableEntry*> cells; ///< one per head; null where print has no figure
  };
  std::string title;
  std::vector<std::string> heads;
  std::vector<Row> rows;
  std::size_t cell_width; ///< characters
};

/// "msm_eigenvalue_2": the second row of the column "msm_eigenvalue".
Layout spectrum_layout(const Sheet& sheet) {
  Layout layout{title_of(sheet), {}, {}, 17};
  for (const Sheet::Row& row : sheet.rows) {
    const std::size_t last = row.measure.rfind('_');
    const std::string head = row.measure.substr(0, last), label = row.measure.substr(last + 1);
    const auto has_label = [&](const Layout::Row& other) { return other.label == label; };
    auto column = std::find(layout.heads.begin(), layout.heads.end(), head);
    if (column == layout.heads.end()) column = layout.heads.insert(column, head);
    auto found = std::find_if(layout.rows.begin(), layout.rows.end(), has_label);
    if (found == layout.rows.end()) found = layout.rows.insert(found, {label, {}});
    const auto place = static_cast<std::size_t>(column - layout.heads.begin());
    if (found->cells.size() <= place) found->cells.resize(place + 1);
    found->cells[place] = row.first;
  }
  for (Layout::Row& row : layout.rows) row.cells.resize(layout.heads.size());
  return layout;
}

std::size_t label_width(const Layout& layout) {
  std::size_t width = 0;
  for (const Layout::Row& row : layout.rows) width = std::max(width, n_characters(row.label));
  return 2 + width;
}

std::size_t width_of(const Layout& layout) {
  return label_width(layout) + layout.heads.size() * layout.cell_width;
}

bool is_narrow(const Layout& layout) {
  return width_of(layout) <= half_screen;
}

std::string difference_text(const TableEntry& entry, const ComputedFigure& computed) {
  const std::string text = value_text(entry.difference(computed), digits_of(entry.published));
  return text.front() == '-' ? text : "+" + text;
}

Lines beside(const Lines& left, const Lines& right) {
  Lines lines;
  for (std::size_t l = 0; l < std::max(left.size(), right.size()); ++l) {
    const std::string start = l < left.size() ? left[l] : "";
    lines.push_back(l < right.size() ? fmt::format("{:<{}}{}", start, half_screen + between_tables, right[l])
                                     : start);
  }
  return lines;
}

Layout layout_of(const Sheet& sheet) {
  if (is_of_one_cell(sheet) && sheet.columns.size() == 1) return spectrum_layout(sheet);
  Layout layout{title_of(sheet), {}, {}, is_of_one_cell(sheet) ? std::size_t{15} : 17};
  for (const auto& column : sheet.columns) layout.heads.push_back(head_of(sheet, column));
  for (const Sheet::Row& row : sheet.rows) layout.rows.push_back({label_of(sheet, row), row.cells});
  return layout;
}

/// A table's lines, without their ends; one that is wider than the screen is divided into parts of as many
/// columns as fit.
Lines lines_of(const Layout& layout) {
  const std::size_t n = layout.heads.size(), labels = label_width(layout);
  const std::size_t n_fitting = std::max<std::size_t>(1, (screen_width - labels) / layout.cell_width);
  const std::size_t n_parts = (n + n_fitting - 1) / n_fitting, n_columns = (n + n_parts - 1) / n_parts;
  Lines lines = lines_in(paragraph(layout.title, "", "  ", is_narrow(layout) ? half_screen : screen_width));
  for (std::size_t from = 0; from < n; from += n_columns) {
    const std::size_t to = std::min(n, from + n_columns);
    std::string heads(labels, ' ');
    for (std::size_t c = from; c < to; ++c)
      heads += fmt::format("{:>{}}", layout.heads[c], layout.cell_width);
    if (heads.find_first_not_of(' ') != std::string::npos) lines.push_back(heads);
    for (const auto& [label, cells] : layout.rows) {
      std::string line = fmt::format("{:<{}}", "  " + label, labels);
      for (std::size_t c = from; c < to; ++c)
        line += fmt::format("{:>{}}", cells[c] ? cell_text(*cells[c]) : "", layout.cell_width);
      lines.push_back(line.substr(0, line.find_last_not_of(' ') + 1));
    }
  }
  return lines;
}

/// Adds the rows of one measure: each reference, print, the difference of the nearest, and what explains a
/// beta_1.
void add_rows(Json& rows, const Sheet::Row& row) {
  const auto& [test, measure, cells, first] = row;
  const int digits = digits_of(first->published);
  const auto add = [&](const std::string& label, const auto& text_of) {
    Json texts = Json::array();
    for (const TableEntry* entry : row.cells) texts.push_back(entry ? text_of(*entry) : std::string());
    rows.push_back({{"test", ""}, {"measure", ""}, {"label", label}, {"cells", texts}});
  };
  const std::size_t n_before = rows.size();
  for (std::size_t k = 0; k < first->computed.size(); ++k)
    add(first->computed[k].reference, [&](const TableEntry& entry) {
      const bool is_marked = entry.computed.size() > 1 && entry.nearest() == &entry.computed[k];
      return value_text(entry.computed[k].value, digits) + (is_marked ? "*" : "");
    });
  rows[n_before].update({{"test", test}, {"measure", measure}});
  add(measure == "beta_1" ? "published (!)" : "published",
      [&](const TableEntry& entry) { return value_text(entry.published.value, digits); });
  add("difference", [&](const TableEntry& entry) {
    const ComputedFigure* nearest = entry.nearest();
    return value_text(nearest ? entry.difference(*nearest) : std::nullopt, digits);
  });
  const auto is_large = [](const TableEntry* e) { return e && e->published.load_set == "large"; };
  // It explains the large rows in print; of the small ones nothing does.
  if (measure == "beta_1" && std::any_of(cells.begin(), cells.end(), is_large))
    add("45 deg + small beta_2", [&](const TableEntry& entry) {
      if (!is_large(&entry)) return std::string();
      const auto [reference, value] = nearest_from_beta_2(entry);
      return value_text(reference ? std::optional(value) : std::nullopt, digits);
    });
}

} // namespace

std::vector<Sheet> sheets_of(const std::vector<TableEntry>& entries) {
  std::vector<Sheet> sheets;
  for (const TableEntry& entry : entries) {
    if (sheets.empty() || sheets.back().table != entry.published.table)
      sheets.push_back({entry.published.table});
    auto& columns = sheets.back().columns;
    sheets.back().entries.push_back(&entry);
    if (std::find(columns.begin(), columns.end(), column_of(entry.published)) == columns.end())
      columns.push_back(column_of(entry.published));
  }
  for (auto& [table, columns, rows, of_table] : sheets)
    for (const TableEntry* entry : of_table) {
      const PublishedFigure& p = entry->published;
      auto row = std::find_if(rows.begin(), rows.end(), [&](const Sheet::Row& r) {
        return r.test == p.test && r.measure == p.measure;
      });
      if (row == rows.end())
        row = rows.insert(row, {p.test, p.measure, std::vector<const TableEntry*>(columns.size()), entry});
      row->cells[std::find(columns.begin(), columns.end(), column_of(p)) - columns.begin()] = entry;
    }
  return sheets;
}

std::string name_of(const Sheet& sheet) {
  return (sheet.table == "5.12" ? "Figure " : "Table ") + sheet.table;
}

std::string name_of(const PublishedFigure& figure) {
  std::string name = figure.test + " " + figure.measure;
  for (const std::string& part : column_of(figure)) name += part.empty() ? "" : ", " + part;
  return name;
}

std::string subject_of(const Sheet& sheet) {
  if (sheet.table == "4.1") return "pseudo-stiffnesses k' of the springs, k = (L0/2) k' E";
  if (sheet.table == "4.2") return "eigenvalues (N/mm for E = 1 MPa, L0 = 2 mm) and multiplicities";
  if (sheet.table == "4.3") return "similarity h of the two matrices' eigenspaces";
  if (sheet.entries.front()->published.unit == "mm3") return "volume of the springs' body, mm3";
  return "error r = (MSM - FEM)/FEM x 100 %";
}

std::string value_text(const std::optional<double>& value, int digits) {
  if (!value) return "-";
  const std::string text = fmt::format("{:.{}f}", *value, digits);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero ? fmt::format("{:.{}f}", 0.0, digits) : text; // never "-0.00"
}

int digits_of(const PublishedFigure& figure) {
  if (figure.measure.find("multiplicity") != std::string::npos) return 0;
  return figure.test == "cell" ? 4 : 2;
}

std::string cell_text(const TableEntry& entry) {
  const ComputedFigure& declared = entry.declared();
  if (!declared.value) return "failed";
  return fmt::format("{} {:>7}{}", value_text(declared.value, digits_of(entry.published)),
                     difference_text(entry, declared),
                     entry.has_failed()               ? "!"
                     : entry.nearest() != &declared   ? "*"
                     : entry.published.test == "cell" ? ""
                                                      : " ");
}

std::vector<std::string> lines_of(const std::vector<Sheet>& sheets) {
  std::vector<Layout> layouts;
  for (const Sheet& sheet : sheets) layouts.push_back(layout_of(sheet));
  Lines all;
  for (std::size_t s = 0; s < layouts.size(); ++s) {
    Lines lines = lines_of(layouts[s]);
    if (s + 1 < layouts.size() && is_narrow(layouts[s]) && is_narrow(layouts[s + 1]))
      lines = beside(lines, lines_of(layouts[++s]));
    if (!all.empty()) all.emplace_back();
    all.insert(all.end(), lines.begin(), lines.end());
  }
  return all;
}

void write_sheet(std::ostream& out, const Sheet& sheet) {
  const bool has_two = sheet.entries.front()->computed.size() > 1;
  fmt::print(out, "\n{}: {}{}\n", name_of(sheet), subject_of(sheet),
             has_two ? "; first the declared reference; * the one nearer to print" : "");
  Columns columns = columns_of("=test =measure{:<} =label{:<}");
  Json rows(2, {{"test", ""}, {"measure", ""}, {"label", ""}}); // further lines of the heading
  for (const auto& column : sheet.columns) {
    columns.push_back({column[0], fmt::format("cells.{}", columns.size() - 3)});
    for (const std::size_t part : {1, 2}) rows[part - 1]["cells"].push_back(column[part]);
  }
  for (const Sheet::Row& row : sheet.rows) add_rows(rows, row);
  write_table(out, columns, rows);
  const bool has_beta_1 = std::any_of(sheet.entries.begin(), sheet.entries.end(),
                                      [](const TableEntry* e) { return e->published.measure == "beta_1"; });
  if (has_beta_1)
    fmt::print(out,
               "  (!) the printed beta_1 is not the rotation that the text defines; ours is: see the end\n");
  for (const TableEntry* entry : sheet.entries)
    for (const ComputedFigure& c : entry->computed) {
      const std::string name = fmt::format("{} ({})", name_of(entry->published), c.reference);
      if (!c.value) fmt::print(out, "  no value: {}: {}\n", name, c.reason);
      fmt::print(out, "  {}: {}\n", name, c.trace.command);
    }
}

} // namespace springproof::compare
