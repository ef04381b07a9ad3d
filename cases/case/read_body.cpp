#include "cases/case/readers.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::cases {

namespace {

Box read_box(Table& table) {
  Box box;
  box.size = table.required("size", Vector{"three numbers above 0 (mm)", is_positive});
  const Entry entry = table.entry("cells");
  const std::string allowed = "three whole numbers above 0";
  double nodes = 1;
  std::size_t a = 0;
  for (const Entry& cells : entry.elements(allowed, 3)) {
    const auto n = cells.value<int64_t>();
    if (!n || *n < 1 || *n > 1000000) entry.refuse(allowed + ", none above a million");
    box.cells[a++] = static_cast<int>(*n);
    nodes *= static_cast<double>(*n) + 1;
  }
  if (!(3 * nodes < 2147483647.0)) entry.refuse("fewer: more than 715 million nodes cannot be numbered");
  return box;
}

/// A name that a class of cells can have: groups of a mesh and faces of a body are regions of the same map.
std::string read_class_name(const Entry& entry) {
  const std::string name = read_text(entry);
  const std::vector<std::string> words = words_of(name);
  const bool is_face = std::all_of(words.begin(), words.end(), [](const std::string& word) {
    return std::find(face_names.begin(), face_names.end(), word) != face_names.end();
  });
  if (is_face) entry.refuse("a name that is not one of a face");
  return name;
}

std::vector<LabelClass> read_classes(Table& table) {
  std::vector<std::string> seen;
  bool has_rigid = false;
  const auto classes = table.sections("classes", [&](Table& row) {
    const Number intensity{"a finite number, an intensity"};
    LabelClass result{row.required("name", read_class_name), row.required("lower", intensity),
                      row.required("upper", intensity), row.optional("rigid", read_truth).value_or(false)};
    if (std::find(seen.begin(), seen.end(), result.name) != seen.end())
      row.entry("name").refuse("another name than the classes before");
    seen.push_back(result.name);
    if (!(result.lower <= result.upper)) row.entry("upper").refuse("at least lower");
    if (result.is_rigid && has_rigid) row.entry("rigid").refuse("true in one class at most");
    has_rigid = has_rigid || result.is_rigid;
    return result;
  });
  if (classes.empty() || classes.size() > 255)
    table.entry("classes").refuse("1 to 255 tables [[body.classes]] with name, lower and upper");
  if (classes.size() == 1 && has_rigid)
    table.entry("classes").refuse("more than one class where one is rigid: nothing would deform");
  return classes;
}

void read_keep(const Entry& entry, Labels& labels) {
  const std::string allowed = "\"largest\" or a point of three finite numbers (mm) in the piece that is kept";
  labels.keep = entry.node && entry.node->is_array() ? Keep::seed : Keep::largest;
  if (labels.keep == Keep::seed)
    labels.seed = Vector{allowed}(entry);
  else if (entry.value<std::string>() != name_of(Keep::largest))
    entry.refuse(allowed);
}

Labels read_labels(Table& table, const std::string& case_path) {
  Labels labels;
  labels.file = read_file_path(table.entry("file"), {".nii", ".gz", ".inv3"},
                               "a picture in three dimensions, .nii, .nii.gz or .inv3", case_path);
  labels.edge = table.required("edge", Number{"a number above 0 (mm), the edge of a cell", is_positive});
  labels.classes = read_classes(table);
  if (table.has("crop")) labels.crop = read_corners(table.entry("crop"));
  if (table.has("keep")) read_keep(table.entry("keep"), labels);
  table.know({"crop", "keep"});
  labels.scale = read_scale(table);
  return labels;
}

} // namespace

std::vector<std::string> names_of(const std::vector<LabelClass>& classes) {
  std::vector<std::string> names;
  for (const LabelClass& one : classes) names.push_back(one.name);
  return names;
}

double read_scale(Table& table) {
  const Number scale{"a number from 1e-9 to 1e9, the mm of a unit of the file",
                     [](double value) { return value >= 1e-9 && value <= 1e9; }};
  return table.optional("scale", scale).value_or(1);
}

Body read_body(Table& table, const std::string& case_path) {
  const std::string shape = table.entry("shape").word({"box", "mesh", "voxels", "labels"});
  if (shape == "box") return read_box(table);
  if (shape == "labels") return read_labels(table, case_path);
  const Entry file = table.entry(shape == "mesh" ? "file" : "surface");
  if (shape == "mesh")
    return MeshFile{read_file_name(file, {".msh", ".geo"}, "a gmsh file, .msh or .geo", case_path),
                    read_scale(table)};
  return Voxels{read_file_name(file, {".stl"}, "a closed surface in STL, .stl", case_path),
                table.required("edge", Number{"a number above 0 (mm), the edge of a cell", is_positive}),
                read_scale(table)};
}

} // namespace springproof::cases
