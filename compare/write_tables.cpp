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
  const ComputedError* nearest = entry.nearest();
  return nearest ? std::optional(*nearest->error_percent - entry.published.error_percent) : std::nullopt;
}

/// What a column of a table stands for: the parts that tell its entries from those of other columns.
std::array<std::string, 3> column_of(const PublishedError& p) {
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
        return number(entry->computed[k].error_percent) + (mark ? "*" : "");
      });
    line("", "", "published", [&](std::size_t c) {
      const TableEntry* entry = sheet.find(r, c);
      return entry ? number(entry->published.error_percent) : std::string();
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
    fmt::print(out, "\nTable {}: error r = (MSM - FEM)/FEM x 100 %{}\n", table,
               of_table.front()->computed.size() > 1 ? "; * the reference nearer to print" : "");
    write_sheet(out, Sheet(of_table));
    fmt::print(out, "  of {} entries", of_table.size());
    for (const Count& count : count_reproduced(of_table))
      fmt::print(out, ", {} within {:g}", count.entries, count.points);
    fmt::print(out, " points of print\n");
    for (const TableEntry* entry : of_table)
      for (const ComputedError& computed : entry->computed)
        if (!computed.error_percent)
          fmt::print(out, "  no value: {} {} nu = {:g} ({}): {}\n", entry->published.test,
                     entry->published.measure, entry->published.poissons_ratio, computed.reference,
                     computed.reason);
  }
}

void write_tables_csv(std::ostream& out, const std::vector<TableEntry>& entries) {
  const auto field = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.6f}", *value) : "";
  };
  fmt::print(out,
             "table,material,poissons_ratio,design,design_poissons_ratio,load_set,test,measure,published,"
             "reference,computed,fem,msm,difference\n");
  for (const TableEntry& entry : entries)
    for (const ComputedError& c : entry.computed) {
      const PublishedError& p = entry.published;
      const auto off = c.error_percent ? std::optional(*c.error_percent - p.error_percent) : std::nullopt;
      fmt::print(out, "{},{},{:g},{},{:g},{},{},{},{:g},{},{},{},{},{}\n", p.table, p.material,
                 p.poissons_ratio, p.design, p.design_poissons_ratio, p.load_set, p.test, p.measure,
                 p.error_percent, c.reference, field(c.error_percent), field(c.fem), field(c.msm),
                 field(off));
    }
}

Json tables_to_json(const std::vector<TableEntry>& entries) {
  const auto or_null = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  Json rows = Json::array();
  std::vector<const TableEntry*> all;
  for (const TableEntry& entry : entries) {
    all.push_back(&entry);
    const PublishedError& p = entry.published;
    const ComputedError& declared = entry.computed.front();
    Json other = Json::object();
    for (std::size_t k = 1; k < entry.computed.size(); ++k)
      other[entry.computed[k].reference] = or_null(entry.computed[k].error_percent);
    rows.push_back({{"table", p.table},
                    {"material", p.material},
                    {"poissons_ratio", p.poissons_ratio},
                    {"design", p.design},
                    {"load_set", p.load_set},
                    {"test", p.test},
                    {"measure", p.measure},
                    {"unit", "%"},
                    {"published", p.error_percent},
                    {"computed", or_null(declared.error_percent)},
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
