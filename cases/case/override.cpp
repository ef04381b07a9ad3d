#include "cases/case/override.hpp"

#include "cases/case/error.hpp"

#include <cctype>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <vector>

namespace springproof::cases {

namespace {

/// One step of a path: a key, and the index behind it, if any.
struct Step {
  std::string key;
  std::optional<std::size_t> index;
};

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// "name" or "name[3]".
std::optional<Step> parse_step(const std::string& text) {
  const std::size_t bracket = text.find('[');
  Step step{text.substr(0, bracket), std::nullopt};
  for (const char c : step.key)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') return std::nullopt;
  if (step.key.empty()) return std::nullopt;
  if (bracket == std::string::npos) return step;
  const std::string digits = text.substr(bracket + 1, text.size() - bracket - 2);
  const bool is_number =
      !digits.empty() && digits.size() <= 6 && digits.find_first_not_of("0123456789") == std::string::npos;
  if (text.back() != ']' || !is_number) return std::nullopt;
  step.index = std::stoul(digits);
  return step;
}

std::vector<Step> parse_path(const std::string& path, const Where& where) {
  std::vector<Step> steps;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const auto step = parse_step(path.substr(begin, end - begin));
    if (!step) throw InputError(where, "is not a key, must be like fem.refine or load[0].value");
    steps.push_back(*step);
    begin = end + 1;
  }
  return steps;
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

/// The element of an array under a key of a table.
toml::node& element(toml::table& table, const Step& step, const Where& where) {
  toml::array* array = table[step.key].as_array();
  const std::size_t size = array ? array->size() : 0;
  if (!array || *step.index >= size)
    throw InputError(
        where, fmt::format("there is no {}[{}], {} has {} elements", step.key, *step.index, step.key, size));
  return (*array)[*step.index];
}

toml::table& descend(toml::table& table, const Step& step, const Where& where) {
  if (!step.index && !table.contains(step.key)) table.insert(step.key, toml::table{});
  toml::node& next = step.index ? element(table, step, where) : *table.get(step.key);
  if (!next.is_table()) throw InputError(where, fmt::format("{} is not a table", step.key));
  return *next.as_table();
}

} // namespace

bool is_line_of_text(const std::string& text) {
  try {
    return toml::parse("#" + text).empty(); // what TOML allows in a comment
  } catch (const toml::parse_error&) {
    return false;
  }
}

void apply_override(toml::table& document, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const std::string path = trimmed(setting.substr(0, equals));
  const Where where{"", 0, 0, path};
  if (equals == std::string::npos) throw InputError(where, "is not KEY=VALUE");
  const std::string text = trimmed(setting.substr(equals + 1));
  if (text.empty()) throw InputError(where, "has no value, must be KEY=VALUE");

  const std::vector<Step> steps = parse_path(path, where);
  toml::table* table = &document;
  for (std::size_t s = 0; s + 1 < steps.size(); ++s) table = &descend(*table, steps[s], where);
  toml::table parsed = parse_value(text, where);
  const Step& last = steps.back();
  parsed.get("value")->visit([&](auto& value) {
    if (last.index) {
      element(*table, last, where);
      toml::array& array = *table->get(last.key)->as_array();
      array.replace(array.cbegin() + static_cast<std::ptrdiff_t>(*last.index), std::move(value));
    } else {
      table->insert_or_assign(last.key, std::move(value));
    }
  });
}

} // namespace springproof::cases
