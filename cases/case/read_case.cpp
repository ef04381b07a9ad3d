#include "cases/case/read_case.hpp"

#include "cases/case/override.hpp"
#include "cases/case/read_boundary.hpp"
#include "cases/case/read_material.hpp"
#include "cases/case/read_measures.hpp"
#include "cases/case/read_models.hpp"
#include "cases/case/read_stress.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace springproof::cases {

namespace {

std::string text_of(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  // A folder opens, but cannot be read.
  if (!file || !(text << file.rdbuf())) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "it is empty or no file";
    throw InputError(Where{path, 0, 0, ""}, "cannot be read: " + reason);
  }
  return text.str();
}

toml::table parse(const std::string& text, const std::string& path) {
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw InputError(Where{path, static_cast<int>(at.line), static_cast<int>(at.column), ""},
                     fmt::format("is not valid TOML: {}", error.description()));
  }
}

/// Names label rows of reports and files of results.
std::string read_case_name(const Entry& entry) {
  const std::string name = read_text(entry);
  constexpr std::size_t longest = 200; // of a file's name 255 bytes are allowed, endings included
  const bool is_clean = name.size() <= longest && name.find_first_of("/\\\"") == std::string::npos &&
                        name.front() != '.' &&
                        std::none_of(name.begin(), name.end(), [](char c) { return c >= 0 && c < ' '; });
  if (!is_clean)
    entry.refuse("a name without /, \\, quotes, line breaks, and a leading dot, of 200 bytes at most: it "
                 "names files of results");
  return name;
}

Box read_box(Table& table) {
  Box box;
  box.size = table.required("size", Vector{"three numbers above 0 (mm)", is_positive});
  const Entry entry = table.entry("cells");
  const std::string allowed = "three whole numbers above 0";
  const std::vector<Entry> cells = entry.elements(allowed);
  if (cells.size() != 3) entry.refuse(allowed);
  double nodes = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto n = cells[a].node->value_exact<int64_t>();
    if (!n || *n < 1 || *n > 1000000) entry.refuse(allowed + ", none above a million");
    box.cells[a] = static_cast<int>(*n);
    nodes *= static_cast<double>(*n) + 1;
  }
  if (!(3 * nodes < 2147483647.0)) entry.refuse("fewer: more than 715 million nodes cannot be numbered");
  return box;
}

/// A file of the body: relative to the case file.
/// @param endings  that are allowed    @param allowed  completes "must be ..."
std::string read_file_name(const Entry& entry, const std::vector<std::string>& endings,
                           const std::string& allowed, const std::string& case_path) {
  const std::filesystem::path file = read_text(entry);
  if (std::find(endings.begin(), endings.end(), file.extension()) == endings.end()) entry.refuse(allowed);
  const std::filesystem::path path = std::filesystem::path(case_path).parent_path() / file;
  std::error_code unreadable; // a name that is too long, for one
  if (!std::filesystem::is_regular_file(path, unreadable))
    entry.refuse(fmt::format("a file that exists: there is no {}", path.lexically_normal().string()));
  return path.lexically_normal().string();
}

MeshFile read_mesh_file(Table& table, const std::string& case_path) {
  const Entry entry = table.entry("file");
  return {read_file_name(entry, {".msh", ".geo"}, "a gmsh file, .msh or .geo", case_path), entry.where};
}

Voxels read_voxels(Table& table, const std::string& case_path) {
  const Entry entry = table.entry("surface");
  Voxels voxels{read_file_name(entry, {".stl"}, "a closed surface in STL, .stl", case_path), 0, entry.where};
  voxels.edge = table.required("edge", Number{"a number above 0 (mm), the edge of a cell", is_positive});
  return voxels;
}

Body read_body(Table& table, const std::string& case_path) {
  const Entry entry = table.entry("shape");
  const auto shape = entry.node ? entry.node->value_exact<std::string>() : std::nullopt;
  if (shape == "box") return read_box(table);
  if (shape == "mesh") return read_mesh_file(table, case_path);
  if (shape == "voxels") return read_voxels(table, case_path);
  entry.refuse_word({"box", "mesh", "voxels"});
}

bool is_zero(const Load& load) {
  return load.value.isZero(0) && load.moment == 0;
}

void read_boundary(Table& root, Case& result) {
  result.fixed = root.sections("fixed", [&](Table& table) { return read_fixed(table, result.body); });
  result.symmetry =
      root.sections("symmetry", [&](Table& table) { return read_symmetry(table, result.body); });
  if (result.fixed.empty() && result.symmetry.empty())
    root.entry("fixed").refuse("one or more tables [[fixed]] or [[symmetry]]: nothing holds the body");
  for (std::size_t i = 0; i < result.symmetry.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (result.symmetry[i].region.name == result.symmetry[j].region.name)
        throw InputError(result.symmetry[i].region.where,
                         fmt::format("is \"{}\", must be another plane than symmetry[{}]",
                                     result.symmetry[i].region.name, j));
  result.moved = root.sections("moved", [&](Table& table) { return read_moved(table, result.body); });
  result.loads = root.sections("load", [&](Table& table) { return read_load(table, result.body); });
  const auto moves = [](const Moved& moved) { return moved.angle != 0 || !moved.displacement.isZero(0); };
  if (std::any_of(result.moved.begin(), result.moved.end(), moves)) return;
  if (result.loads.empty()) root.entry("load").refuse("one or more tables [[load]] or [[moved]]");
  if (std::all_of(result.loads.begin(), result.loads.end(), is_zero)) {
    Table first(root.entry("load").elements("tables").front(), "a table");
    first.entry("value").refuse("other than 0, here or in another [[load]]: nothing would move");
  }
}

void read_measures(Table& root, Case& result) {
  std::vector<std::string> seen;
  result.measures = root.sections("measure", [&](Table& table) {
    Measure measure = read_measure(table, result.body);
    if (std::find(seen.begin(), seen.end(), measure.name) != seen.end())
      table.entry("name").refuse(
          fmt::format("a new name: measure[{}] has this one",
                      std::find(seen.begin(), seen.end(), measure.name) - seen.begin()));
    seen.push_back(measure.name);
    return measure;
  });
  result.expectations =
      root.sections("expect", [&](Table& table) { return read_expectation(table, result.measures); });
}

toml::table parse_file(const std::string& path, const std::vector<std::string>& overrides) {
  if (!is_line_of_text(path)) throw InputError("the name of a case file must be one line of UTF-8 text");
  toml::table document = parse(text_of(path), path);
  for (const std::string& setting : overrides) apply_override(document, setting);
  return document;
}

Case read_definition(Table& root, const std::string& path) {
  Case result;
  result.file = path;
  root.required("schema", WholeNumber{"1, the version of the format that this program reads", 1, 1});
  result.name = root.required("name", read_case_name);
  result.description = root.optional("description", read_text).value_or("");
  result.body = root.section("body", [&](Table& table) { return read_body(table, path); });
  result.material = root.section("material", read_material);
  result.region_materials = root.sections("region_material", [&](Table& table) {
    return read_region_material(table, result.material, result.body);
  });
  read_boundary(root, result);
  result.fem = root.optional_section(
      "fem", [&](Table& table) { return read_fem(table, result.material, result.body); });
  result.msm = root.optional_section("msm", [&](Table& table) { return read_msm(table, result.material); });
  check_region_materials(result);
  read_measures(root, result);
  check_accuracy(root, result);
  return result;
}

Case read_document(const toml::table& document, const std::string& path) {
  Table root({&document, Where{path, 1, 1, ""}}, "a table");
  if (root.has("stress"))
    root.entry("stress").refuse("left out: this is a hard case, for the command stress alone");
  Case result = read_definition(root, path);
  root.refuse_unknown_keys();
  return result;
}

} // namespace

Case read_case(const std::string& path, const std::vector<std::string>& overrides) {
  return read_document(parse_file(path, overrides), path);
}

Case read_case_text(const std::string& text, const std::string& path) {
  return read_document(parse(text, path), path);
}

Case read_hard_case(const std::string& path) {
  const toml::table document = parse_file(path, {});
  Table root({&document, Where{path, 1, 1, ""}}, "a table");
  Case result = read_definition(root, path);
  result.stress = root.section("stress", [&](Table& table) { return read_stress(table, result.msm); });
  root.refuse_unknown_keys();
  return result;
}

} // namespace springproof::cases
