#include "compare/tables.hpp"

#include "cases/read_case.hpp"
#include "compare/measure.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <tuple>

namespace compare {

namespace {

/// The finite-element side that a table is held against.
struct Reference {
  std::string formulation, element;
  std::string name() const { return formulation + " " + element; }
};

struct ErrorTable {
  std::string number;
  std::vector<Reference> references;
};

const std::vector<ErrorTable>& error_tables() {
  // The first reference of a table is the declared one. Print mixes two for the linear elastic material, so
  // both are computed.
  const std::vector<Reference> linear_elastic{{"log_strain", "q1_bbar"}, {"small_strain", "q1_bbar"}};
  const std::vector<Reference> ogden{{"hyperelastic", "q1_p0"}};
  static const std::vector<ErrorTable> tables{
      {"4.5", linear_elastic}, {"4.6", linear_elastic}, {"4.7", linear_elastic},
      {"5.1", ogden},          {"5.2", ogden},          {"5.3", linear_elastic},
      {"5.4", linear_elastic}, {"5.12", ogden}}; // 5.12 is a figure: the bar
  return tables;
}

const ErrorTable& find_table(const std::string& number) {
  for (const ErrorTable& table : error_tables())
    if (table.number == number) return table;
  throw cases::InputError(
      fmt::format("table '{}' is not known; there are {}", number, fmt::join(known_tables(), ", ")));
}

/// One side of a case: what one solve depends on.
struct Solve {
  std::string case_file;
  std::vector<std::string> settings;
  Only side;
  bool operator<(const Solve& other) const {
    return std::tie(case_file, settings, side) < std::tie(other.case_file, other.settings, other.side);
  }
};

std::string case_file_of(const PublishedFigure& entry) {
  if (entry.load_set.empty()) return fmt::format("thesis/{}/{}.toml", entry.material, entry.test);
  return fmt::format("thesis/{}/cube_{}_{}.toml", entry.material, entry.test, entry.load_set);
}

Solve fem_solve(const PublishedFigure& entry, const Reference& reference) {
  std::vector<std::string> settings{"fem.formulation=" + reference.formulation,
                                    "fem.element=" + reference.element};
  if (entry.material == "linear_elastic")
    settings.push_back(fmt::format("material.poissons_ratio={}", entry.poissons_ratio));
  return {case_file_of(entry), settings, Only::fem};
}

/// Stiffnesses that the thesis prints are used as printed; the bar's case files scale them to their cells.
Solve msm_solve(const PublishedFigure& entry) {
  if (entry.load_set.empty()) return {case_file_of(entry), {}, Only::msm};

  const auto k = published_stiffness(entry.design, entry.material, entry.design_poissons_ratio);
  if (k)
    return {case_file_of(entry),
            {"msm.design=given", fmt::format("msm.stiffness=[{}, {}, {}]", (*k)[0], (*k)[1], (*k)[2])},
            Only::msm};
  return {case_file_of(entry),
          {"msm.design=" + entry.design, fmt::format("msm.poissons_ratio={}", entry.design_poissons_ratio)},
          Only::msm};
}

const MeasuredValue* find_measure(const Comparison& comparison, const std::string& name) {
  for (const MeasuredValue& measured : comparison.measures)
    if (measured.name == name) return &measured;
  return nullptr;
}

/// The figure of one entry from the two solves behind it.
ComputedFigure combine(const Comparison& fem, const Comparison& msm, const PublishedFigure& published,
                       ComputedFigure entry) {
  const std::string& measure = published.measure;
  const MeasuredValue *on_fem = find_measure(fem, measure), *on_msm = find_measure(msm, measure);
  if (!on_fem || !on_msm) {
    entry.reason = "the case has no measure " + measure;
    return entry;
  }
  entry.fem = on_fem->fem;
  entry.msm = on_msm->msm;
  if (published.unit == "mm3")
    entry.value = entry.msm;
  else if (entry.fem && entry.msm)
    entry.value = error_percent(*entry.fem, *entry.msm);
  if (!entry.value) entry.reason = fem.fem.solution.message + msm.msm.solution.message;
  return entry;
}

} // namespace

const ComputedFigure* TableEntry::nearest() const {
  const ComputedFigure* best = nullptr;
  const auto distance = [&](const ComputedFigure& c) { return std::abs(*c.value - published.value); };
  for (const ComputedFigure& candidate : computed)
    if (candidate.value && (!best || distance(candidate) < distance(*best))) best = &candidate;
  return best;
}

std::vector<std::string> known_tables() {
  std::vector<std::string> numbers;
  for (const ErrorTable& table : error_tables()) numbers.push_back(table.number);
  return numbers;
}

std::vector<TableEntry> regenerate(const std::vector<std::string>& tables,
                                   const std::function<void(int done, int all)>& progress) {
  std::vector<PublishedFigure> wanted;
  for (const std::string& number : tables) find_table(number);
  for (const PublishedFigure& published : read_published_figures())
    if (std::find(tables.begin(), tables.end(), published.table) != tables.end()) wanted.push_back(published);

  std::map<Solve, Comparison> solves; // a solve that several tables stand on is done once
  for (const PublishedFigure& published : wanted) {
    solves[msm_solve(published)];
    for (const Reference& reference : find_table(published.table).references)
      solves[fem_solve(published, reference)];
  }
  int done = 0;
  for (auto& [solve, comparison] : solves) {
    comparison =
        compare_case(cases::read_case(cases_folder() + "/" + solve.case_file, solve.settings), solve.side);
    progress(++done, static_cast<int>(solves.size()));
  }

  std::vector<TableEntry> entries;
  for (const PublishedFigure& published : wanted) {
    TableEntry entry{published, {}};
    const Solve msm = msm_solve(published);
    for (const Reference& reference : find_table(published.table).references) {
      const Solve fem = fem_solve(published, reference);
      ComputedFigure computed{reference.name(), {}, {}, {}, "", fem.case_file, fem.settings};
      computed.settings.insert(computed.settings.end(), msm.settings.begin(), msm.settings.end());
      entry.computed.push_back(combine(solves.at(fem), solves.at(msm), published, computed));
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

} // namespace compare
