#include "cases/case/override.hpp"

#include "cases/case/error.hpp"

#include <fmt/format.h>
#include <regex>

namespace springproof::cases {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Steps "name" or "name[3]" joined by points.
toml::path parse_path(const std::string& path, const Where& where) {
  static const std::regex form(R"([\w-]+(\[\d{1,6}\])?(\.[\w-]+(\[\d{1,6}\])?)*)");
  constexpr std::size_t longest = 1000; // std::regex needs stack for every character
  if (path.size() > longest || !std::regex_match(path, form))
    throw InputError(where, "is not a key, must be like fem.refine or load[0].value");
  return toml::path(path);
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
  const Where where{"", 0, 0, trimmed(setting.substr(0, equals))};
  if (equals == std::string::npos) throw InputError(where, "is not KEY=VALUE");
  const std::string text = trimmed(setting.substr(equals + 1));
  if (text.empty()) throw InputError(where, "has no value, must be KEY=VALUE");

  const toml::path path = parse_path(where.key, where);
  toml::table parsed = parse_value(text, where);
  toml::node* node = &document;
  std::string key; // the last one on the way
  for (std::size_t s = 0; s < path.size(); ++s) {
    const bool is_last = s + 1 == path.size();
    if (path[s].type() == toml::path_component_type::key) {
      toml::table* const table = node->as_table();
      if (!table) throw InputError(where, fmt::format("{} is not a table", key));
      key = path[s].key();
      if (is_last)
        table->insert_or_assign(key, std::move(*parsed.get("value")));
      else
        node = &table->emplace<toml::table>(key).first->second;
    } else {
      toml::array* const array = node->as_array();
      const std::size_t i = path[s].index(), size = array ? array->size() : 0;
      if (i >= size)
        throw InputError(where, fmt::format("there is no {}[{}], {} has {} elements", key, i, key, size));
      if (is_last)
        array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(i), std::move(*parsed.get("value")));
      else
        node = array->get(i);
    }
  }
}

} // namespace springproof::cases
