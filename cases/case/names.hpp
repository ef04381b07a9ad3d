#pragma once

#include "cases/case/case.hpp"
#include "cases/case/solution.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// How the enumerators of the shared vocabulary are written, in case files, reports and messages alike. A new
/// enumerator is one line in its table in names.cpp.
namespace springproof::cases {

template<class Enum>
using NameTable = std::vector<std::pair<Enum, const char*>>;

/// The table of one enumeration, in the order in which messages list it.
template<class Enum>
const NameTable<Enum>& names();

template<>
const NameTable<LoadKind>& names();
template<>
const NameTable<Formulation>& names();
template<>
const NameTable<Element>& names();
template<>
const NameTable<Design>& names();
template<>
const NameTable<LoadPath>& names();
template<>
const NameTable<Solver>& names();
template<>
const NameTable<MeasureKind>& names();
template<>
const NameTable<Axis>& names();
template<>
const NameTable<Component>& names();
template<>
const NameTable<ReferenceKind>& names();
template<>
const NameTable<Quantity>& names();
template<>
const NameTable<Status>& names();
template<>
const NameTable<Outcome>& names();

/// Name of an enumerator; every enumerator has one.
template<class Enum>
std::string name_of(Enum value) {
  for (const auto& [known, name] : names<Enum>())
    if (known == value) return name;
  return "?"; // an enumerator without its line in names.cpp; tests/cases/names_test.cpp guards against it
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

/// Of the known words the one nearest to what was written: at most one edit (insertion, deletion,
/// replacement, or exchange of two neighbours) for every three letters. Nothing if none is that near.
std::optional<std::string> nearest_name(const std::string& written, const std::vector<std::string>& known);

} // namespace springproof::cases
