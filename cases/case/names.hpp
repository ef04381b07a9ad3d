#pragma once

#include "cases/case/enumeration.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// How the enumerators of the shared vocabulary are written, in case files, reports and messages alike.
namespace springproof::cases {

/// Lists every field of a type in its order, beneath the type and in its namespace, so that cereal can keep
/// and send its values. A field that is added to the type and not here does not compile.
#define SPRINGPROOF_FIELDS(Type, ...)                                                                        \
  template<class Archive>                                                                                    \
  void serialize(Archive& archive, Type& listed) {                                                           \
    auto& [__VA_ARGS__] = listed;                                                                            \
    archive(__VA_ARGS__);                                                                                    \
  }

/// Character between the words of a name. An enumeration may have an overload of its own.
template<class Enum>
char between_words(Enum) {
  return '_';
}

/// The enumerators of a list separated by commas.
std::vector<std::string> split_enumerators(const char* list, char between_words);

/// Every name of a SPRINGPROOF_ENUMERATION, in the order in which messages list them.
template<class Enum>
const std::vector<std::string>& all_names() {
  static const auto names = split_enumerators(enumerators(Enum{}), between_words(Enum{}));
  return names;
}

/// Name of an enumerator.
template<class Enum>
std::string name_of(Enum value) {
  return all_names<Enum>().at(static_cast<std::size_t>(value));
}

/// Enumerator with that name, if there is one.
template<class Enum>
std::optional<Enum> value_of(const std::string& name) {
  for (std::size_t n = 0; n < all_names<Enum>().size(); ++n)
    if (all_names<Enum>()[n] == name) return static_cast<Enum>(n);
  return std::nullopt;
}

/// The kinds of a thing as the types of a variant, each with its `name` in case files. Code that treats every
/// kind overloads a function for each of these types: a kind that is forgotten does not compile.
template<class Variant>
struct Kinds;
template<class... Kind>
struct Kinds<std::variant<Kind...>> {
  static const std::vector<std::string>& names() {
    static const std::vector<std::string> all{Kind::name...};
    return all;
  }
  /// @param name  one of names()
  static std::variant<Kind...> named(const std::string& name) {
    std::variant<Kind...> kind;
    ((name == Kind::name ? void(kind = Kind{}) : void()), ...);
    return kind;
  }
};

/// Name of a kind.
template<class... Kind>
std::string name_of(const std::variant<Kind...>& kind) {
  return std::visit([](const auto& one) -> std::string { return one.name; }, kind);
}

/// Whether a load, a measure, ... is of a kind.
template<class Kind, class Thing>
bool is(const Thing& thing) {
  return std::holds_alternative<Kind>(thing.kind);
}

/// The words of a list as a message shows them: "a" | "b" | "c".
std::string alternatives(const std::vector<std::string>& words);
/// The same for the names of some enumerators.
template<class Enum>
std::string alternatives(const std::vector<Enum>& some) {
  std::vector<std::string> names;
  for (const Enum one : some) names.push_back(name_of(one));
  return alternatives(names);
}

/// Whether a list has a value.
template<class List, class Value>
bool contains(const List& list, const Value& value) {
  return std::find(std::begin(list), std::end(list), value) != std::end(list);
}

/// The known word with the fewest edits (insertion, deletion, replacement, exchange of neighbours) from what
/// was written, at most one for every three letters; nothing if there is none.
std::optional<std::string> nearest_name(const std::string& written, const std::vector<std::string>& known);

/// The words of a text between blanks.
std::vector<std::string> words_of(const std::string& text);

/// The faces of a box, which regions are made of.
extern const std::vector<std::string> face_names;

/// Whether these words, at least one, are all names of faces.
bool are_faces(const std::vector<std::string>& words);

} // namespace springproof::cases
