#pragma once

#include "cases/case/error.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <set>
#include <toml++/toml.h>

/// Typed access to a TOML document whose every failure is an InputError that says where, which key, which
/// value, and what is allowed. Only readers of TOML files include this.
namespace springproof::cases {

/// Parses TOML 1.0 with at most 100 points a line.  @param path  its name in messages   @throws InputError
toml::table parse_document(const std::string& text, const std::string& path);
/// The same for a file, whose name must be a line of UTF-8, so that it can stand in messages and JSON, with
/// settings of the command line: "fem.refine=1", "load[0].value=[0, 0, 0.01]", "fem.element=q2". A value is
/// TOML; what is not valid TOML is taken as a text, so that words need no quotes. Tables that do not exist
/// are made; elements of arrays must exist.
/// @throws InputError, also if a setting is not KEY=VALUE or leads through something that is no table
toml::table parse_file(const std::string& path, const std::vector<std::string>& settings);

/// The value of a key. A missing key is an entry without a node, so that one line of a reader reports both
/// missing and wrong values.
struct Entry {
  const toml::node* node;
  Where where;

  /// Throws InputError "is VALUE, must be ALLOWED", or "is missing, must be ALLOWED".
  [[noreturn]] void refuse(const std::string& allowed) const;
  /// The same for what is allowed in fmt's format.
  template<class First, class... More>
  [[noreturn]] void refuse(fmt::format_string<First, More...> allowed, First&& first, More&&... more) const {
    refuse(fmt::format(allowed, std::forward<First>(first), std::forward<More>(more)...));
  }
  /// The value, if it is of that type: std::string, bool, int64_t.
  template<class Type>
  std::optional<Type> value() const {
    return node ? node->value_exact<Type>() : std::nullopt;
  }
  /// A word out of a list; refuses anything else, with the nearest one as a suggestion.
  std::string word(const std::vector<std::string>& allowed) const;
  /// The elements of an array; refuses anything else, and, unless `count` is 0, any other number of them.
  std::vector<Entry> elements(const std::string& allowed, std::size_t count = 0) const;
};

// Readers: functions of an entry that return a checked value.

using Condition = std::function<bool(double)>;
inline constexpr auto is_anything = [](double) { return true; };
inline constexpr auto is_positive = [](double value) { return value > 0; };
inline constexpr auto is_not_negative = [](double value) { return value >= 0; };

/// A text that is not empty.
std::string read_text(const Entry& entry);

/// The name of a file that exists, relative to the case file.
/// @param endings  allowed ones    @param allowed  completes "must be ..."    @param case_path  the case's
NamedFile read_file_name(const Entry& entry, const std::vector<std::string>& endings,
                         const std::string& allowed, const std::string& case_path);

/// The same for a file that need not be there before the body is made: a package's data.
NamedFile read_file_path(const Entry& entry, const std::vector<std::string>& endings,
                         const std::string& allowed, const std::string& case_path);

/// One finite number, whole or not. `allowed` completes "must be ...".
struct Number {
  std::string allowed;
  Condition condition = is_anything;
  double operator()(const Entry& entry) const;
};

/// true or false.
bool read_truth(const Entry& entry);

/// An array of finite numbers, `count` of them, or one and more when count is 0.
struct Numbers {
  std::string allowed;
  std::size_t count;
  Condition condition = is_anything;
  std::vector<double> operator()(const Entry& entry) const;
};

/// That many finite numbers.
template<std::size_t count>
struct Array {
  std::string allowed;
  Condition condition = is_anything;
  std::array<double, count> operator()(const Entry& entry) const {
    const std::vector<double> read = Numbers{allowed, count, condition}(entry);
    std::array<double, count> values{};
    std::copy(read.begin(), read.end(), values.begin());
    return values;
  }
};

/// Three finite numbers.
struct Vector {
  std::string allowed;
  Condition condition = is_anything;
  Eigen::Vector3d operator()(const Entry& entry) const;
};

/// Two corners of a box (mm), the lower one first in each coordinate.
struct Corners {
  bool may_be_flat = false; ///< a rectangle, a line or a point
  std::pair<Eigen::Vector3d, Eigen::Vector3d> operator()(const Entry& entry) const;
};

/// Two finite numbers, the smaller first: Less is std::less_equal if they may be equal.
template<class Less = std::less<>>
struct Interval {
  std::string allowed;
  Condition condition = is_anything;
  std::array<double, 2> operator()(const Entry& entry) const {
    const auto ends = Array<2>{allowed, condition}(entry);
    if (!Less()(ends[0], ends[1])) entry.refuse(allowed);
    return ends;
  }
};

struct WholeNumber {
  std::string allowed;
  int lowest, highest;
  int operator()(const Entry& entry) const;
};

/// The name of an enumerator.
template<class Enum>
Enum read_name(const Entry& entry) {
  return *value_of<Enum>(entry.word(all_names<Enum>()));
}

/// A kind of a thing, by its name.
template<class Variant>
Variant read_kind(const Entry& entry) {
  return Kinds<Variant>::named(entry.word(Kinds<Variant>::names()));
}

/// A table that records which keys were read: the others are unknown keys.
class Table {
 public:
  Table(const Entry& entry, const std::string& allowed);

  /// Where the table begins.
  const Where& where() const { return where_; }
  bool has(const std::string& key) const { return table_->contains(key); }
  /// The value of a key. If it is missing and a key that was not read is similar, that one is reported
  /// as misspelt.
  Entry entry(const std::string& key);
  /// These keys are known, whether they are read or not.
  void know(std::initializer_list<const char*> keys) { asked_.insert(keys.begin(), keys.end()); }
  /// Refuses keys that have no meaning beside the others; they are known then, whether they are read or not.
  /// @param instead  "left out: REASON"
  void refuse_unless(bool have_meaning, std::initializer_list<const char*> keys, const std::string& instead);

  template<class Reader>
  auto required(const std::string& key, const Reader& read) {
    return read(entry(key));
  }
  template<class Reader>
  auto optional(const std::string& key, const Reader& read) -> std::optional<decltype(read(entry(key)))> {
    asked_.insert(key);
    if (!has(key)) return std::nullopt;
    return read(entry(key));
  }
  /// [key]: a table, read by a function of Table&; unknown keys in it are refused.
  template<class Reader>
  auto section(const std::string& key, const Reader& read) {
    Table table(entry(key), "a table [" + key + "]");
    auto value = read(table);
    table.refuse_unknown_keys();
    return value;
  }
  /// The same for a table that may be left out: then there is no value.
  template<class Reader>
  auto section_if_there(const std::string& key, const Reader& read) {
    asked_.insert(key);
    return has(key) ? std::optional(section(key, read)) : std::nullopt;
  }
  /// The same for a table that may be left out: then the reader gets an empty one.
  template<class Reader>
  auto optional_section(const std::string& key, const Reader& read) {
    static const toml::table nothing;
    if (has(key)) return section(key, read);
    asked_.insert(key);
    Table empty({&nothing, place_of(key)}, "a table");
    return read(empty);
  }
  /// [[key]]: any number of tables, read one by one.
  template<class Reader>
  auto sections(const std::string& key, const Reader& read) {
    std::vector<decltype(read(*this))> values;
    asked_.insert(key);
    if (!has(key)) return values;
    const std::string allowed = "one or more tables [[" + key + "]]";
    for (const Entry& element : entry(key).elements(allowed)) {
      Table table(element, allowed);
      values.push_back(read(table));
      table.refuse_unknown_keys();
    }
    return values;
  }
  /// Throws InputError at the first key that was not read, with the nearest known one.
  void refuse_unknown_keys() const;

 private:
  [[noreturn]] void refuse_key(const toml::key& key, const toml::node& value,
                               const std::string& problem) const;
  /// Place for a missing key.
  Where place_of(const std::string& key) const;

  const toml::table* table_;
  Where where_;
  std::set<std::string> asked_;
};

} // namespace springproof::cases
