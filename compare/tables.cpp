#include "compare/tables.hpp"

#include "cases/read_case.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

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
  static const std::vector<ErrorTable> tables{
      {"4.5", {{"small_strain", "q1_bbar"}}},
  };
  return tables;
}

const ErrorTable& find_table(const std::string& number) {
  for (const ErrorTable& table : error_tables())
    if (table.number == number) return table;
  throw cases::InputError(
      fmt::format("table '{}' is not known; there are {}", number, fmt::join(known_tables(), ", ")));
}

/// What turns the test's case file into the one behind a printed figure. Stiffnesses that the thesis prints
/// are used as printed.
std::vector<std::string> settings_for(const PublishedError& entry, const Reference& reference) {
  std::vector<std::string> settings{"fem.formulation=" + reference.formulation,
                                    "fem.element=" + reference.element};
  if (entry.material == "linear_elastic")
    settings.push_back(fmt::format("material.poissons_ratio={}", entry.poissons_ratio));
  if (const auto k = published_stiffness(entry.design, entry.material, entry.design_poissons_ratio)) {
    settings.push_back("msm.design=given");
    settings.push_back(fmt::format("msm.stiffness=[{}, {}, {}]", (*k)[0], (*k)[1], (*k)[2]));
  } else {
    settings.push_back("msm.design=" + entry.design);
    settings.push_back(fmt::format("msm.poissons_ratio={}", entry.design_poissons_ratio));
  }
  return settings;
}

ComputedError take(const Comparison& comparison, const std::string& measure, ComputedError entry) {
  const auto found = std::find_if(comparison.measures.begin(), comparison.measures.end(),
                                  [&](const MeasuredValue& m) { return m.name == measure; });
  if (found == comparison.measures.end()) {
    entry.reason = "the case has no measure " + measure;
    return entry;
  }
  entry.fem = found->fem;
  entry.msm = found->msm;
  entry.error_percent = found->error_percent;
  if (!entry.error_percent) entry.reason = comparison.fem.solution.message + comparison.msm.solution.message;
  return entry;
}

} // namespace

const ComputedError* TableEntry::nearest() const {
  const ComputedError* best = nullptr;
  const auto distance = [&](const ComputedError& c) {
    return std::abs(*c.error_percent - published.error_percent);
  };
  for (const ComputedError& candidate : computed)
    if (candidate.error_percent && (!best || distance(candidate) < distance(*best))) best = &candidate;
  return best;
}

std::vector<std::string> known_tables() {
  std::vector<std::string> numbers;
  for (const ErrorTable& table : error_tables()) numbers.push_back(table.number);
  return numbers;
}

std::vector<TableEntry> regenerate(const std::vector<std::string>& tables,
                                   const std::function<void(int done, int all)>& progress) {
  using Key = std::pair<std::string,
                        std::vector<std::string>>; // case file and settings: what a comparison depends on
  std::vector<TableEntry> entries;
  std::map<Key, std::optional<Comparison>> comparisons;
  for (const std::string& number : tables) find_table(number);
  for (const PublishedError& published : read_published_errors()) {
    if (std::find(tables.begin(), tables.end(), published.table) == tables.end()) continue;
    TableEntry entry{published, {}};
    for (const Reference& reference : find_table(published.table).references) {
      const std::string file =
          fmt::format("thesis/{}/cube_{}_{}.toml", published.material, published.test, published.load_set);
      entry.computed.push_back({reference.name(), {}, {}, {}, "", file, settings_for(published, reference)});
      comparisons[{file, entry.computed.back().settings}] = std::nullopt;
    }
    entries.push_back(std::move(entry));
  }
  int done = 0;
  for (auto& [key, comparison] : comparisons) {
    comparison = compare_case(cases::read_case(cases_folder() + "/" + key.first, key.second));
    progress(++done, static_cast<int>(comparisons.size()));
  }
  for (TableEntry& entry : entries)
    for (ComputedError& computed : entry.computed)
      computed =
          take(*comparisons.at({computed.case_file, computed.settings}), entry.published.measure, computed);
  return entries;
}

} // namespace compare
