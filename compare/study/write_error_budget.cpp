#include "compare/study/error_budget.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

Json part_to_json(const ErrorPart& part) {
  Json json = SPRINGPROOF_MEMBERS(part, percent, uncertainty);
  json["reason"] = text_or_null(part.reason);
  return json;
}

constexpr double told_part = 1e-3; ///< part of the whole: smaller ones are left out of sentences

/// "-1.2 (law) + 15 (mesh)", without parts that are next to nothing.
std::string sum_text(const ErrorBudget& budget) {
  std::string text;
  for (const NamedPart& named : error_parts) {
    const std::optional<double>& percent = (budget.*named.part).percent;
    if (!percent || std::abs(*percent) < told_part * std::abs(*budget.whole)) continue;
    const char* sign = *percent < 0 ? "-" : "+";
    text += text.empty() ? fmt::format("{}{:.2g} ({})", sign, std::abs(*percent), named.name)
                         : fmt::format(" {} {:.2g} ({})", sign, std::abs(*percent), named.name);
  }
  return text;
}

const NamedPart& largest_part(const ErrorBudget& budget) {
  const auto size = [&](const NamedPart& named) {
    return std::abs((budget.*named.part).percent.value_or(0));
  };
  return *std::max_element(error_parts.begin(), error_parts.end(),
                           [&](const NamedPart& a, const NamedPart& b) { return size(a) < size(b); });
}

/// What the worst measure's error of a model is made of, and what to change first.
std::string advice_on(const std::vector<ErrorBudget>& budgets, const char* model) {
  const ErrorBudget* worst = nullptr;
  for (const ErrorBudget& budget : budgets)
    if (budget.sum() && (!worst || std::abs(*budget.whole) > std::abs(*worst->whole))) worst = &budget;
  if (!worst) return "";
  const NamedPart& largest = largest_part(*worst);
  return fmt::format("{}, {}: {:+.3g} % is {}.{} The largest part is of the {}: try {} first.", model,
                     worst->measure, *worst->whole, sum_text(*worst),
                     worst->cancels() ? " Parts of opposite sign cancel more than half of the error." : "",
                     largest.name, largest.remedy);
}

std::vector<std::string> advice(const ErrorBudgets& budgets) {
  std::vector<std::string> sentences;
  for (const auto& [model, all] : {std::pair("springs", &budgets.springs), {"finite elements", &budgets.fem}})
    if (std::string sentence = advice_on(*all, model); !sentence.empty())
      sentences.push_back(std::move(sentence));
  return sentences;
}

} // namespace

std::string part_text(const ErrorPart& part) {
  if (!part.percent) return "-";
  if (!part.reason.empty()) return "0";
  const std::string percent = fmt::format("{:+.2f}", *part.percent);
  return part.uncertainty > 0 ? percent + fmt::format(" +- {:.2g}", part.uncertainty) : percent;
}

Json error_budget_to_json(const ErrorBudget& budget) {
  Json json{{"measure", budget.measure}};
  for (const NamedPart& named : error_parts) json[named.name] = part_to_json(budget.*named.part);
  json["sum"] = budget.sum();
  json["whole"] = budget.whole;
  json["cancels"] = budget.cancels();
  json["reason"] = text_or_null(budget.reason);
  return json;
}

Json error_budgets_to_json(const ErrorBudgets& budgets) {
  return {{"lattices", budgets.lattices},
          {"note", text_or_null(budgets.note)},
          {"advice", advice(budgets)},
          {"msm", json_list(budgets.springs, error_budget_to_json)},
          {"fem", json_list(budgets.fem, error_budget_to_json)}};
}

void write_error_budget_text(std::ostream& out, const ErrorBudgets& budgets) {
  Json rows = Json::array();
  std::vector<std::string> reasons;
  for (const auto& [model, all] : {std::pair("springs", &budgets.springs), {"finite elements", &budgets.fem}})
    for (const ErrorBudget& budget : *all) {
      rows.push_back(error_budget_to_json(budget));
      rows.back()["model"] = model;
      for (const NamedPart& named : error_parts) rows.back()[named.name] = part_text(budget.*named.part);
      const auto tell = [&](const std::string& reason) {
        const std::string line = budget.measure + ": " + reason;
        if (std::find(reasons.begin(), reasons.end(), line) == reasons.end()) reasons.push_back(line);
      };
      if (!budget.reason.empty()) tell(budget.reason);
      for (const NamedPart& named : error_parts)
        if (const ErrorPart& part = budget.*named.part; !part.percent && !part.reason.empty())
          tell(part.reason);
    }
  out << "  error by its causes, % of the finite elements' limit\n";
  write_table(out, columns_of("model measure{<} law mesh step iterations sum{:+.2f} whole{:+.2f}"), rows);
  if (!budgets.note.empty()) write_wrapped(out, "  " + budgets.note, 4);
  for (const std::string& reason : reasons) write_wrapped(out, "  " + reason, 4);
  for (const std::string& sentence : advice(budgets)) write_wrapped(out, "  " + sentence, 4);
}

} // namespace springproof::compare
