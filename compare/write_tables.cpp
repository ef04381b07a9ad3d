#include "compare/tables.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <nlohmann/json.hpp>

namespace compare {

using Json = nlohmann::ordered_json;

namespace {

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::optional<double> difference(const TableEntry& entry) {
  const ComputedFigure* nearest = entry.nearest();
  return nearest ? std::optional(*nearest->value - entry.published.value) : std::nullopt;
}

/// What a column of a table stands for: the parts that tell its entries from those of other columns.
std::array<std::string, 3> column_of(const PublishedFigure& p) {
  return {p.design, fmt::format("nu = {:g}", p.poissons_ratio), p.load_set};
}

template<class Value>
void add_unique(std::vector<Value>& values, const Value& value) {
  for (const Value& known : values)
    if (known == value) return;
  values.push_back(value);
}

/// One table as a grid of its entries.
struct Sheet {
  std::vector<std::pair<std::string, std::string>> rows; ///< test, measure
  std::vector<std::array<std::string, 3>> columns;
  std::vector<const TableEntry*> entries;
  explicit Sheet(std::vector<const TableEntry*> of_table) : entries(std::move(of_table)) {
    for (const TableEntry* entry : entries) {
      add_unique(rows, {entry->published.test, entry->published.measure});
      add_unique(columns, column_of(entry->published));
    }
  }
  const TableEntry* find(std::size_t row, std::size_t column) const {
    for (const TableEntry* entry : entries)
      if (rows[row] == std::pair(entry->published.test, entry->published.measure) &&
          columns[column] == column_of(entry->published))
        return entry;
    return nullptr;
  }
};

void write_sheet(std::ostream& out, const Sheet& sheet) {
  const auto line = [&](const std::string& test, const std::string& measure, const std::string& label,
                        const auto& cell) {
    fmt::print(out, "  {:<8} {:<8} {:<22}", test, measure, label);
    for (std::size_t c = 0; c < sheet.columns.size(); ++c) fmt::print(out, " {:>16}", cell(c));
    fmt::print(out, "\n");
  };
  for (std::size_t part = 0; part < 3; ++part)
    line("", "", "", [&](std::size_t c) { return sheet.columns[c][part]; });
  for (std::size_t r = 0; r < sheet.rows.size(); ++r) {
    const auto& [test, measure] = sheet.rows[r];
    const auto& references = sheet.find(r, 0)->computed;
    for (std::size_t k = 0; k < references.size(); ++k)
      line(k == 0 ? test : "", k == 0 ? measure : "", references[k].reference, [&](std::size_t c) {
        const TableEntry* entry = sheet.find(r, c);
        if (!entry) return std::string();
        const bool mark = references.size() > 1 && entry->nearest() == &entry->computed[k];
        return number(entry->computed[k].value) + (mark ? "*" : "");
      });
    line("", "", "published", [&](std::size_t c) {
      const TableEntry* entry = sheet.find(r, c);
      return entry ? number(entry->published.value) : std::string();
    });
    line("", "", "difference", [&](std::size_t c) {
      const TableEntry* entry = sheet.find(r, c);
      return entry ? number(difference(*entry)) : std::string();
    });
  }
}

struct Count {
  double points;
  int entries;
};

/// How many entries come within so many points of print.
std::vector<Count> count_reproduced(const std::vector<const TableEntry*>& entries) {
  std::vector<Count> counts{{0.1, 0}, {0.5, 0}, {1, 0}, {2, 0}};
  for (const TableEntry* entry : entries)
    if (const auto d = difference(*entry))
      for (Count& count : counts)
        if (std::abs(*d) <= count.points) ++count.entries;
  return counts;
}

} // namespace

void write_tables_text(std::ostream& out, const std::vector<TableEntry>& entries) {
  std::vector<std::string> numbers;
  for (const TableEntry& entry : entries) add_unique(numbers, entry.published.table);
  for (const std::string& table : numbers) {
    std::vector<const TableEntry*> of_table;
    for (const TableEntry& entry : entries)
      if (entry.published.table == table) of_table.push_back(&entry);
    fmt::print(out, "\n{} {}: {}{}\n", table == "5.12" ? "Figure" : "Table", table,
               of_table.front()->published.unit == "%" ? "error r = (MSM - FEM)/FEM x 100 %"
                                                       : "volume of the springs' body, mm3",
               of_table.front()->computed.size() > 1 ? "; * the reference nearer to print" : "");
    write_sheet(out, Sheet(of_table));
    fmt::print(out, "  of {} entries", of_table.size());
    for (const Count& count : count_reproduced(of_table))
      fmt::print(out, ", {} within {:g}", count.entries, count.points);
    fmt::print(out, " {} of print\n", of_table.front()->published.unit == "%" ? "points" : "mm3");
    for (const TableEntry* entry : of_table)
      for (const ComputedFigure& computed : entry->computed)
        if (!computed.value)
          fmt::print(out, "  no value: {} {} nu = {:g} ({}): {}\n", entry->published.test,
                     entry->published.measure, entry->published.poissons_ratio, computed.reference,
                     computed.reason);
  }
}

void write_tables_csv(std::ostream& out, const std::vector<TableEntry>& entries) {
  const auto field = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.6f}", *value) : "";
  };
  fmt::print(
      out, "table,material,poissons_ratio,design,design_poissons_ratio,load_set,test,measure,published,unit,"
           "reference,computed,fem,msm,difference\n");
  for (const TableEntry& entry : entries)
    for (const ComputedFigure& c : entry.computed) {
      const PublishedFigure& p = entry.published;
      const auto off = c.value ? std::optional(*c.value - p.value) : std::nullopt;
      fmt::print(out, "{},{},{:g},{},{:g},{},{},{},{:g},{},{},{},{},{},{}\n", p.table, p.material,
                 p.poissons_ratio, p.design, p.design_poissons_ratio, p.load_set, p.test, p.measure, p.value,
                 p.unit, c.reference, field(c.value), field(c.fem), field(c.msm), field(off));
    }
}

Json tables_to_json(const std::vector<TableEntry>& entries) {
  const auto or_null = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  Json rows = Json::array();
  std::vector<const TableEntry*> all;
  for (const TableEntry& entry : entries) {
    if (entry.published.unit == "%") all.push_back(&entry);
    const PublishedFigure& p = entry.published;
    const ComputedFigure& declared = entry.computed.front();
    Json other = Json::object();
    for (std::size_t k = 1; k < entry.computed.size(); ++k)
      other[entry.computed[k].reference] = or_null(entry.computed[k].value);
    rows.push_back({{"table", p.table},
                    {"material", p.material},
                    {"poissons_ratio", p.poissons_ratio},
                    {"design", p.design},
                    {"load_set", p.load_set},
                    {"test", p.test},
                    {"measure", p.measure},
                    {"unit", p.unit},
                    {"published", p.value},
                    {"computed", or_null(declared.value)},
                    {"reference", declared.reference},
                    {"other", other},
                    {"case", declared.case_file},
                    {"settings", declared.settings}});
  }
  Json summary{{"entries", entries.size()}};
  for (const Count& count : count_reproduced(all))
    summary[fmt::format("within_{:g}_points", count.points)] = count.entries;
  return {{"schema", 1}, {"entries", rows}, {"summary", summary}};
}

} // namespace compare
