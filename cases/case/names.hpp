#pragma once

#include "cases/case/case.hpp"
#include "cases/case/solution.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// How the enumerators of the shared vocabulary are written, in case files, reports and messages alike.
namespace springproof::cases {

template<class Enum>
using NameTable = std::vector<std::pair<Enum, std::string>>;

/// The enumerators 0, 1, ... of a list separated by commas.
std::vector<std::string> split_enumerators(const char* list);

/// Names of a SPRINGPROOF_ENUMERATION, in the order in which messages list them.
template<class Enum>
const NameTable<Enum>& names() {
  static const NameTable<Enum> table = [] {
    NameTable<Enum> all;
    for (std::string& name : split_enumerators(enumerators(Enum{})))
      all.emplace_back(static_cast<Enum>(all.size()), std::move(name));
    return all;
  }();
  return table;
}

/// Written with blanks: "stable equilibrium".
template<>
const NameTable<Outcome>& names();

/// Name of an enumerator.
template<class Enum>
std::string name_of(Enum value) {
  for (const auto& [known, name] : names<Enum>())
    if (known == value) return name;
  return "?"; // not an enumerator
}

/// Enumerator of that name, if there is one.
template<class Enum>
std::optional<Enum> value_of(const std::string& name) {
  for (const auto& [value, known] : names<Enum>())
    if (known == name) return value;
  return std::nullopt;
}

/// Every name of an enumeration, in order.
template<class Enum>
std::vector<std::string> all_names() {
  std::vector<std::string> all;
  for (const auto& entry : names<Enum>()) all.emplace_back(entry.second);
  return all;
}

/// The words of a list as a message shows them: "a" | "b" | "c".
std::string alternatives(const std::vector<std::string>& words);

/// The known word with the fewest edits (insertion, deletion, replacement, exchange of neighbours) from what
/// was written, at most one for every three letters; nothing if there is none.
std::optional<std::string> nearest_name(const std::string& written, const std::vector<std::string>& known);

} // namespace springproof::cases
