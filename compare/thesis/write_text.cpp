#include "compare/thesis/write.hpp"

#include "cases/case/names.hpp"
#include "cases/case/readers.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <set>

namespace springproof::compare {

namespace {

/// Reasons that are told on the screen; the audit has all.
constexpr std::size_t n_told_reasons = 3, characters_of_reason = 180;

template<class Is>
bool any_of(const std::vector<TableEntry>& entries, const Is& is) {
  return std::any_of(entries.begin(), entries.end(), is);
}

/// What the marks in the tables mean, as far as there are any.
void write_marks(std::ostream& out, const std::vector<TableEntry>& entries) {
  std::set<std::string> others;
  for (const TableEntry& entry : entries)
    if (const ComputedFigure* nearest = entry.nearest(); nearest && nearest != &entry.declared())
      others.insert(nearest->reference + " (the case declares " + entry.declared().reference + ")");
  if (!others.empty())
    write_paragraph(
        out,
        fmt::format("print is nearer to the other reference of the thesis, which counts as well: {}",
                    fmt::join(others, ", ")),
        "  *    ", "       ");
  if (any_of(entries, [](const TableEntry& entry) { return entry.published.measure == "beta_1"; }))
    write_paragraph(out, "the printed beta_1 is not the rotation that the text defines; ours is", "  (!)  ",
                    "       ");
}

/// Each reason once, with the first figure that has it.
void write_failures(std::ostream& out, const std::vector<TableEntry>& entries) {
  std::vector<std::string> reasons, lines;
  for (const TableEntry& entry : entries)
    for (const ComputedFigure& computed : entry.computed) {
      if (computed.value || std::find(reasons.begin(), reasons.end(), computed.reason) != reasons.end())
        continue;
      reasons.push_back(computed.reason);
      lines.push_back(fmt::format("failed: {} {}, {}: {}", entry.published.table, name_of(entry.published),
                                  computed.reference, computed.reason));
    }
  for (std::size_t l = 0; l < std::min(lines.size(), n_told_reasons); ++l)
    write_paragraph(out, in_short(one_line(lines[l]), characters_of_reason), "  ", "    ");
  if (lines.size() > n_told_reasons)
    print(out, "  and {} more reasons, in the audit\n", lines.size() - n_told_reasons);
}

/// "1 point", "2 mm3", "0.005".
std::string bound_text(const SummaryGroup& group) {
  if (group.unit == "points" && group.listing_bound == 1) return "1 point";
  return fmt::format("{:g}{}{}", group.listing_bound, group.unit.empty() ? "" : " ", group.unit);
}

void write_counts(std::ostream& out, const std::vector<TableEntry>& entries) {
  int n_reproduced = 0, n_failed = 0;
  std::vector<std::string> parts;
  for (const SummaryGroup& group : summarise(entries)) {
    n_reproduced += group.n_reproduced;
    n_failed += group.n_failed;
    parts.push_back(fmt::format("{}: {} of {} within {}", group.name, group.n_reproduced, group.n_entries,
                                bound_text(group)));
  }
  const int n = static_cast<int>(entries.size());
  print(out, "{} published values: {} reproduced, {} not, {} failed\n", n, n_reproduced,
        n - n_reproduced - n_failed, n_failed);
  write_paragraph(out, fmt::format("{}", fmt::join(parts, "; ")), "  ", "  ");
  write_failures(out, entries);
}

Json worst_to_json(const CubeErrors& cube) {
  return {cube.small.worst, cube.large.worst};
}

/// The design that a case of this Poisson's ratio takes when it names none, among those that were measured.
const Advice* default_at(const std::vector<Advice>& advice, double poissons_ratio) {
  const cases::Design design = cases::default_design({cases::LinearElastic{1, poissons_ratio}}, {}, true);
  const auto found = std::find_if(advice.begin(), advice.end(), [&](const Advice& a) {
    return a.poissons_ratio == poissons_ratio && a.design == cases::name_of(design);
  });
  return found == advice.end() ? nullptr : &*found;
}

void write_advice_table(std::ostream& out, const std::vector<Advice>& advice) {
  if (advice.empty()) return;
  print(out, "\nWhich design to use: worst |error| on the thesis's cube, %, with loads in proportion to E\n");
  Json rows = Json::array();
  bool differs = false;
  for (const Advice& best : advice) {
    if (!best.is_recommended) continue;
    const Advice* by_default = default_at(advice, best.poissons_ratio);
    rows.push_back({{"nu", best.poissons_ratio},
                    {"use", best.design},
                    {"cube", worst_to_json(best.cube)},
                    {"volume", best.cube.worst_volume()},
                    {"default", by_default == &best ? "the same"
                                : by_default        ? by_default->design
                                                    : ""}});
    if (by_default && by_default != &best) rows.back()["other"] = worst_to_json(by_default->cube);
    differs = differs || by_default != &best;
  }
  write_table(out,
              columns_of("nu{:<g} use{:<} small=cube.0{:.1f} large=cube.1{:.1f} volume{:.1f} "
                         "without~a~name=default{:<} small=other.0{:.1f} large=other.1{:.1f}"),
              rows);
  write_paragraph(
      out,
      "The design to use has the smallest worst error of those that are stable in every test; its "
      "stiffnesses: springproof design --young E --poisson NU --method NAME.",
      "  ", "  ");
  if (differs)
    write_paragraph(
        out,
        "A case of forces on nodes that names no design takes the one on the right: its rule asks "
        "for a large lattice that stays stable, not for this cube alone.",
        "  ", "  ");
}

} // namespace

void write_tables_text(std::ostream& out, const ThesisResults& results) {
  print(out, "Each figure: ours, then its difference from the printed one. r = (MSM - FEM)/FEM x 100 %.\n\n");
  for (const std::string& line : lines_of(sheets_of(results.entries))) out << line << '\n';
  write_marks(out, results.entries);
  out << '\n';
  write_counts(out, results.entries);
  write_advice_table(out, results.advice);
}

void write_where_text(std::ostream& out, const ThesisResults& results, const std::string& folder) {
  if (folder.empty())
    return write_paragraph(out,
                           "Audit of each figure (every reference, what is known of it, the command that "
                           "repeats it): springproof tables --trace, or --out DIR for files.");
  std::string names = "report.html";
  if (!results.designs.empty()) names += ", designs.csv, advice.csv";
  if (!results.cases.empty()) names += ", volumes.csv, box_plot.csv";
  write_paragraph(out, fmt::format("Audit of each figure: audit.txt, tables.csv and tables.json in {}; also "
                                   "there: {}.",
                                   folder, names));
}

} // namespace springproof::compare
