#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "cases/case/read_case.hpp"
#include "compare/fit/fit.hpp"
#include "compare/measure/measure.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

enum class Role { case_name, setting, coordinate, marker, measure, surface, deviation };

struct DataColumn {
  Role role;
  std::string name; ///< the key's, the measure's; of a deviation the measure's, or empty: all of the row
  int axis = 0;     ///< a coordinate's or a marker's
};

/// Cases that rows are of, with their measures.
struct KnownCase {
  std::string file, name;
  bool is_held_out;
  std::vector<cases::Measure> measures;
};

std::vector<KnownCase> known_cases(const FitCases& all) {
  std::vector<KnownCase> known;
  for (const bool is_held_out : {false, true})
    for (const std::string& file : is_held_out ? all.held_out : all.files) {
      const cases::Case definition = cases::read_case(file, all.settings);
      for (const KnownCase& earlier : known)
        if (earlier.name == definition.name)
          throw cases::InputError(
              fmt::format("{}: is named \"{}\" as {} is, and rows of data are told apart by "
                          "names; give it another",
                          file, definition.name, earlier.file));
      known.push_back({file, definition.name, is_held_out, definition.measures});
    }
  return known;
}

constexpr const char* sigma = "sigma";

std::string listed_measures(const std::vector<KnownCase>& known) {
  std::vector<std::string> names;
  for (const KnownCase& one : known)
    for (const cases::Measure& measure : one.measures)
      if (!cases::contains(names, measure.name)) names.push_back(measure.name);
  return names.empty() ? "none: the cases have no [[measure]]" : cases::alternatives(names);
}

bool is_measure(const std::vector<KnownCase>& known, const std::string& name) {
  return std::any_of(known.begin(), known.end(),
                     [&](const KnownCase& one) { return find_named(one.measures, name) != nullptr; });
}

DataColumn column_of(const std::string& name, const std::vector<KnownCase>& known, const std::string& place) {
  if (is_measure(known, name)) return {Role::measure, name};
  if (name == "case") return {Role::case_name, name};
  if (name == "x" || name == "y" || name == "z") return {Role::coordinate, name, name[0] - 'x'};
  if (name == "ux" || name == "uy" || name == "uz") return {Role::marker, name, name[1] - 'x'};
  if (name == "surface") return {Role::surface, name};
  if (name == sigma) return {Role::deviation, ""};
  const std::string suffix = std::string(" ") + sigma;
  if (name.size() > suffix.size() && name.substr(name.size() - suffix.size()) == suffix)
    if (const std::string of = name.substr(0, name.size() - suffix.size());
        is_measure(known, of) || of == "ux" || of == "uy" || of == "uz" || of == "surface")
      return {Role::deviation, of};
  if (name.find('.') != std::string::npos) return {Role::setting, name};
  throw cases::InputError(
      fmt::format("{}\"{}\" is no column, must be a measure of the cases ({}), one of "
                  "them with \" sigma\" behind it, a key "
                  "such as load[0].value[2], or case, surface, sigma, x, y, z, ux, uy, uz",
                  place, name, listed_measures(known)));
}

/// One row's fields by the columns' roles.
class RowReader {
 public:
  RowReader(FitData& data, const FitCases& cases, const std::vector<KnownCase>& known,
            const std::vector<DataColumn>& columns)
      : data_(data), cases_(cases), known_(known), columns_(columns) {}

  void operator()(const cases::TextRow& row) {
    if (columns_.empty())
      throw cases::InputError(row.place() +
                              "is no heading; a file of data begins with the names of its columns: "
                              "measures of the case, keys, or x, y, z, ux, uy, uz");
    if (row.fields.size() != columns_.size())
      throw cases::InputError(fmt::format("{}has {} fields, must have {} as the heading has", row.place(),
                                          row.fields.size(), columns_.size()));
    const KnownCase& of = case_of(row);
    const std::size_t state = state_of(of, row);
    const std::optional<Eigen::Vector3d> point = point_of(row);
    bool has_data = false;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const DataColumn& column = columns_[c];
      if (row.fields[c].empty()) continue;
      if (column.role == Role::surface) {
        has_data = true;
        add_surface(data_.states[state], std::string(row.fields[c]), row);
        continue;
      }
      if ((column.role != Role::measure && column.role != Role::marker)) continue;
      has_data = true;
      const double value = number(row, c);
      data_.data.push_back(
          {state, measure_of(of, column, point, row), value, deviation_of(row, column.name), row.number});
      if (column.role == Role::marker) data_.states[state].markers.push_back(data_.data.back().measure);
    }
    if (!has_data) throw cases::InputError(row.place() + "has no datum: every field of a measure is empty");
  }

 private:
  static double number(const cases::TextRow& row, std::size_t column) {
    const auto value = cases::number_in<double>(row.fields[column]);
    if (!value)
      throw cases::InputError(fmt::format("{}\"{}\" is no finite number", row.place(), row.fields[column]));
    return *value;
  }

  const KnownCase& case_of(const cases::TextRow& row) const {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (columns_[c].role != Role::case_name) continue;
      std::vector<std::string> names;
      for (const KnownCase& one : known_) {
        if (one.name == row.fields[c]) return one;
        names.push_back(one.name);
      }
      throw cases::InputError(fmt::format("{}case is \"{}\", must be {}", row.place(), row.fields[c],
                                          cases::alternatives(names)));
    }
    if (known_.size() > 1)
      throw cases::InputError(row.name +
                              ": there are several cases, and no column \"case\" tells which one a "
                              "row is of; add one with their names");
    return known_.front();
  }

  std::size_t state_of(const KnownCase& of, const cases::TextRow& row) {
    FitState state{of.file, {}, of.is_held_out};
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (columns_[c].role == Role::setting && !row.fields[c].empty())
        state.settings.push_back(fmt::format("{}={}", columns_[c].name, row.fields[c]));
    const auto is_it = [&](const FitState& s) {
      return s.file == state.file && s.settings == state.settings;
    };
    const auto found = std::find_if(data_.states.begin(), data_.states.end(), is_it);
    if (found != data_.states.end()) return static_cast<std::size_t>(found - data_.states.begin());
    data_.states.push_back(state);
    return data_.states.size() - 1;
  }

  /// The marker's place at rest.
  std::optional<Eigen::Vector3d> point_of(const cases::TextRow& row) const {
    Eigen::Vector3d point;
    int n = 0;
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (columns_[c].role == Role::coordinate && !row.fields[c].empty()) {
        point[columns_[c].axis] = number(row, c);
        ++n;
      }
    return n == 3 ? std::optional(point) : std::nullopt;
  }

  std::optional<double> deviation_of(const cases::TextRow& row, const std::string& measure) const {
    for (const std::string& name : {measure, std::string()}) // its own before the row's
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        if (columns_[c].role != Role::deviation || columns_[c].name != name) continue;
        const double deviation = number(row, c);
        if (!(deviation > 0))
          throw cases::InputError(
              fmt::format("{}{:g} is no standard deviation, must be above 0", row.place(), deviation));
        return deviation;
      }
    return std::nullopt;
  }

  void add_surface(FitState& state, const std::string& file, const cases::TextRow& row) const {
    if (state.surface)
      throw cases::InputError(row.place() + "the state has a surface already: join them in one file");
    const auto folder = std::filesystem::path(row.name).parent_path();
    state.surface = read_measured_surface((folder / file).string(), scene_of(cases_, state), row.place());
    state.surface->deviation = deviation_of(row, "surface");
  }

  static cases::Measure measure_of(const KnownCase& of, const DataColumn& column,
                                   const std::optional<Eigen::Vector3d>& point, const cases::TextRow& row) {
    const cases::Where where{row.name, row.number, 1, column.name};
    if (column.role == Role::measure) {
      if (const cases::Measure* measure = find_named(of.measures, column.name)) {
        if (is_field_norm(measure->kind))
          throw cases::InputError(
              fmt::format("{}{}: is the norm of a field, which --to limit fits", row.place(), column.name));
        return *measure;
      }
      throw cases::InputError(
          fmt::format("{}case {} has no measure \"{}\"", row.place(), of.name, column.name));
    }
    if (!point)
      throw cases::InputError(row.place() + column.name +
                              ": markers need the columns x, y and z, their places at rest");
    cases::Region at{"", *point, where};
    at.is_in_cell = true;
    return {fmt::format("{} at ({:g}, {:g}, {:g})", column.name, (*point)[0], (*point)[1], (*point)[2]),
            cases::measures::Displacement{at, static_cast<cases::Component>(column.axis)}, where};
  }

  FitData& data_;
  const FitCases& cases_;
  const std::vector<KnownCase>& known_;
  const std::vector<DataColumn>& columns_;
};

} // namespace

FitData read_fit_data(const std::string& text, const std::string& name, const FitCases& cases) {
  const std::vector<KnownCase> known = known_cases(cases);
  FitData data;
  std::vector<DataColumn> columns;
  RowReader read(data, cases, known, columns);
  std::vector<std::string> names;
  const auto heading = [&](const cases::TextRow& row) {
    for (const std::string_view field : row.fields) {
      const std::string column(field);
      if (cases::contains(names, column))
        throw cases::InputError(fmt::format("{}\"{}\" is there twice", row.place(), column));
      names.push_back(column);
      columns.push_back(column_of(column, known, row.place()));
    }
  };
  cases::read_rows(text, name, cases::Between::commas, heading, read);
  if (data.states.empty()) throw cases::InputError(name + ": has no rows of data");
  for (const KnownCase& one : known)
    if (std::none_of(data.states.begin(), data.states.end(),
                     [&](const FitState& state) { return state.file == one.file; }))
      throw cases::InputError(fmt::format("{}: has no data of {}", name, one.file));
  std::vector<bool> have_deviations;
  for (const Datum& datum : data.data) have_deviations.push_back(datum.deviation.has_value());
  for (const FitState& state : data.states)
    if (state.surface) have_deviations.push_back(state.surface->deviation.has_value());
  const auto n_with = std::count(have_deviations.begin(), have_deviations.end(), true);
  if (n_with != 0 && n_with != static_cast<std::ptrdiff_t>(have_deviations.size()))
    throw cases::InputError(fmt::format("{}: {} of {} data have a standard deviation, must be all or none",
                                        name, n_with, have_deviations.size()));
  return data;
}

} // namespace springproof::compare
