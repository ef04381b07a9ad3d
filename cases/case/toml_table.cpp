#include "cases/case/toml_table.hpp"

#include "cases/case/input_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <regex>
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

/// Says how to drop a key of the file that a key from the command line leaves without a meaning. Empty: no
/// key comes from the command line, or the refused one does too.
std::string how_to_replace(const toml::table& table, const std::string& name, const Where& refused) {
  std::vector<std::string> given;
  for (const auto& [key, value] : table)
    if (!value.source().path && !value.is_table())
      given.push_back(fmt::format("{} = {}", std::string(key), shown(value)));
  if (given.empty() || name.empty() || refused.line == 0) return "";
  return fmt::format("; without what the file has there: --set '{}={{{}}}'", name, fmt::join(given, ", "));
}

std::optional<double> finite_number(const toml::node* node) {
  if (!node || !node->is_number()) return std::nullopt;
  const double value = *node->value<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// toml++ makes a table of every part of a dotted key, and destroys nested tables by recursion.
/// @throws InputError for a line that would nest them deeper than the stack bears
void check_lines(const std::string& text, const std::string& path) {
  constexpr std::ptrdiff_t most_points = 100;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (std::count(line.begin(), line.end(), '.') > most_points)
      refuse(Where{path, number, 1, ""},
             "has more than {} points, must be divided: a list may have several lines", most_points);
}

/// Steps "name" or "name[3]" joined by points.
toml::path parse_path(const std::string& path, const Where& where) {
  static const std::regex form(R"([\w-]+(\[\d{1,6}\])?(\.[\w-]+(\[\d{1,6}\])?)*)");
  constexpr std::size_t longest = 1000; // std::regex needs stack for every character
  if (path.size() > longest || !std::regex_match(path, form))
    throw InputError(where, "is not a key, must be like fem.refine or load[0].value");
  return toml::path(path);
}

/// One line of UTF-8 without control characters.
bool is_line_of_text(const std::string& text) {
  try {
    return toml::parse("#" + text).empty(); // TOML allows the same in a comment
  } catch (const toml::parse_error&) {
    return false;
  }
}

/// The value as a table {value = ...}: parsed as TOML, or else the text itself.
toml::table parse_value(const std::string& text, const Where& where) {
  try {
    toml::table parsed = toml::parse("value = " + text);
    if (parsed.size() == 1) return parsed;
  } catch (const toml::parse_error&) {
    // a bare word
  }
  if (!is_line_of_text(text)) throw InputError(where, "is not one line of UTF-8 text");
  return toml::table{{"value", text}};
}

/// Puts a setting into a document.
void apply_override(toml::table& document, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const Where where{"", 0, 0, std::string(without_blanks(std::string_view(setting).substr(0, equals)))};
  if (equals == std::string::npos) throw InputError(where, "is not KEY=VALUE");
  const std::string text(without_blanks(std::string_view(setting).substr(equals + 1)));
  if (text.empty()) throw InputError(where, "has no value, must be KEY=VALUE");

  const toml::path path = parse_path(where.key, where);
  toml::table parsed = parse_value(text, where);
  toml::node* node = &document;
  std::string key; // the last one on the way
  for (std::size_t s = 0; s < path.size(); ++s) {
    const bool is_last = s + 1 == path.size();
    if (path[s].type() == toml::path_component_type::key) {
      toml::table* const table = node->as_table();
      if (!table) refuse(where, "{} is not a table", key);
      key = path[s].key();
      if (is_last)
        table->insert_or_assign(key, std::move(*parsed.get("value")));
      else
        node = &table->emplace<toml::table>(key).first->second;
    } else {
      toml::array* const array = node->as_array();
      const std::size_t i = path[s].index(), size = array ? array->size() : 0;
      if (i >= size) refuse(where, "there is no {}[{}], {} has {} elements", key, i, key, size);
      if (is_last)
        array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(i), std::move(*parsed.get("value")));
      else
        node = array->get(i);
    }
  }
}

} // namespace

void Entry::refuse(const std::string& allowed) const {
  cases::refuse(where, "is {}, must be {}", node ? shown(*node) : "missing", allowed);
}

std::string Entry::word(const std::vector<std::string>& allowed) const {
  const auto written = value<std::string>();
  if (written && contains(allowed, *written)) return *written;
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
  know(keys);
  for (const char* key : keys) {
    if (have_meaning || !has(key)) continue;
    const Entry refused = entry(key);
    refused.refuse(instead + how_to_replace(*table_, where_.key, refused.where));
  }
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

toml::table parse_document(const std::string& text, const std::string& path) {
  check_lines(text, path);
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    refuse(Where{path, static_cast<int>(at.line), static_cast<int>(at.column), ""}, "is not valid TOML: {}",
           error.description());
  }
}

toml::table parse_file(const std::string& path, const std::vector<std::string>& settings) {
  if (!is_line_of_text(path)) throw InputError("the name of a case file must be one line of UTF-8 text");
  toml::table document = parse_document(read_text_file(path, largest_case), path);
  for (const std::string& setting : settings) apply_override(document, setting);
  return document;
}

NamedFile read_file_path(const Entry& entry, const std::vector<std::string>& endings,
                         const std::string& allowed, const std::string& case_path) {
  const std::filesystem::path file = read_text(entry);
  if (!contains(endings, file.extension())) entry.refuse(allowed);
  return {(std::filesystem::path(case_path).parent_path() / file).lexically_normal().string(), entry.where};
}

NamedFile read_file_name(const Entry& entry, const std::vector<std::string>& endings,
                         const std::string& allowed, const std::string& case_path) {
  NamedFile file = read_file_path(entry, endings, allowed, case_path);
  std::error_code unreadable; // a name that is too long, for one
  if (!std::filesystem::is_regular_file(file.path, unreadable))
    entry.refuse("a file that exists: there is no {}", file.path);
  return file;
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> Corners::operator()(const Entry& entry) const {
  const std::string allowed = "two corners, the lower first: [[x, y, z], [x, y, z]] (mm)";
  const std::vector<Entry> corners = entry.elements(allowed, 2);
  const Eigen::Vector3d lower = Vector{allowed}(corners[0]), upper = Vector{allowed}(corners[1]);
  const bool is_box =
      may_be_flat ? (lower.array() <= upper.array()).all() : (lower.array() < upper.array()).all();
  if (!is_box) entry.refuse(allowed);
  return {lower, upper};
}

} // namespace springproof::cases
