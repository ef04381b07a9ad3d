#include "cases/case/toml_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

namespace springproof::cases {

namespace {

std::string written(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("\"{}\"", text->get());
  if (const auto* number = node.as_floating_point())
    return fmt::format("{:#}", number->get()); // 0.7, not 0.69999999999999996
  if (const auto* array = node.as_array()) {
    std::string elements;
    for (const toml::node& element : *array) elements += (elements.empty() ? "" : ", ") + written(element);
    return "[" + elements + "]";
  }
  if (node.is_table()) return "a table";
  std::ostringstream stream;
  node.visit([&](const auto& value) { stream << value; });
  return stream.str();
}

/// A value as TOML writes it, on one line and not longer than a message bears.
std::string shown(const toml::node& node) {
  std::istringstream words(written(node));
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  constexpr std::size_t longest = 80;
  return line.size() <= longest ? line : line.substr(0, longest) + "...";
}

/// A node from the command line has neither file nor line.
Where place_of(const toml::source_region& source, const std::string& key) {
  if (!source.path) return {"", 0, 0, key};
  return {*source.path, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column), key};
}

std::optional<double> finite_number(const toml::node* node) {
  if (!node || !node->is_number()) return std::nullopt;
  const double value = *node->value<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

} // namespace

void Entry::refuse(const std::string& allowed) const {
  throw InputError(where, fmt::format("is {}, must be {}", node ? shown(*node) : "missing", allowed));
}

std::string Entry::word(const std::vector<std::string>& allowed) const {
  const auto written = value<std::string>();
  if (written && std::find(allowed.begin(), allowed.end(), *written) != allowed.end()) return *written;
  const auto nearest = written ? nearest_name(*written, allowed) : std::nullopt;
  refuse(alternatives(allowed) + (nearest ? fmt::format("; did you mean \"{}\"?", *nearest) : ""));
}

std::vector<Entry> Entry::elements(const std::string& allowed, std::size_t count) const {
  const toml::array* array = node ? node->as_array() : nullptr;
  if (!array || array->empty() || (count != 0 && array->size() != count)) refuse(allowed);
  std::vector<Entry> entries;
  for (const toml::node& element : *array) {
    const std::string key = fmt::format("{}[{}]", where.key, entries.size());
    entries.push_back({&element, place_of(element.source(), key)});
  }
  return entries;
}

std::string read_text(const Entry& entry) {
  const auto text = entry.value<std::string>();
  if (!text || text->find_first_not_of(" \t\r\n") == std::string::npos)
    entry.refuse("a text in quotes, not empty");
  return *text;
}

bool read_truth(const Entry& entry) {
  const auto value = entry.value<bool>();
  if (!value) entry.refuse("true or false");
  return *value;
}

double Number::operator()(const Entry& entry) const {
  const auto value = finite_number(entry.node);
  if (!value || !condition(*value)) entry.refuse(allowed);
  return *value;
}

std::vector<double> Numbers::operator()(const Entry& entry) const {
  std::vector<double> values;
  for (const Entry& element : entry.elements(allowed, count)) {
    const auto value = finite_number(element.node);
    if (!value || !condition(*value)) entry.refuse(allowed);
    values.push_back(*value);
  }
  return values;
}

Eigen::Vector3d Vector::operator()(const Entry& entry) const {
  return Eigen::Vector3d(Numbers{allowed, 3, condition}(entry).data());
}

int WholeNumber::operator()(const Entry& entry) const {
  const auto value = entry.value<int64_t>();
  if (!value || *value < lowest || *value > highest) entry.refuse(allowed);
  return static_cast<int>(*value);
}

Table::Table(const Entry& entry, const std::string& allowed) : where_(entry.where) {
  table_ = entry.node ? entry.node->as_table() : nullptr;
  if (!table_) entry.refuse(allowed);
}

Where Table::place_of(const std::string& key) const {
  Where where = where_;
  where.key = where.key.empty() ? key : where.key + "." + key;
  return where;
}

Entry Table::entry(const std::string& key) {
  asked_.insert(key);
  if (const toml::node* node = table_->get(key))
    return {node, cases::place_of(node->source(), place_of(key).key)};
  for (const auto& [other, value] : *table_)
    if (asked_.count(std::string(other)) == 0 && nearest_name(std::string(other), {key}))
      refuse_key(other, value, fmt::format("is not a key here; did you mean \"{}\"?", key));
  return {nullptr, place_of(key)};
}

void Table::refuse_unless(bool have_meaning, std::initializer_list<const char*> keys,
                          const std::string& instead) {
  for (const char* key : keys)
    if (!have_meaning && has(key)) entry(key).refuse(instead);
}

void Table::refuse_key(const toml::key& key, const toml::node& value, const std::string& problem) const {
  // A key from the command line has no position in the file; the position is that of its value.
  const toml::source_region& source = value.source().path ? key.source() : value.source();
  throw InputError(cases::place_of(source, place_of(std::string(key)).key), problem);
}

void Table::refuse_unknown_keys() const {
  for (const auto& [key, value] : *table_) {
    if (asked_.count(std::string(key)) != 0) continue;
    std::string problem = fmt::format("is not a key here, allowed are {}", fmt::join(asked_, ", "));
    if (const auto nearest = nearest_name(std::string(key), {asked_.begin(), asked_.end()}))
      problem += fmt::format("; did you mean \"{}\"?", *nearest);
    refuse_key(key, value, problem);
  }
}

} // namespace springproof::cases
