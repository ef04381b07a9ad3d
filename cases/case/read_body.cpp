#include "cases/case/readers.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <tuple>

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
  if (are_faces(words_of(name))) entry.refuse("a name that is not one of a face");
  return name;
}

std::vector<LabelClass> read_classes(Table& table) {
  std::vector<std::string> seen;
  bool has_rigid = false;
  const auto classes = table.sections("classes", [&](Table& row) {
    const Number intensity{"a finite number, an intensity"};
    LabelClass result{row.required("name", read_class_name), row.required("lower", intensity),
                      row.required("upper", intensity), row.optional("rigid", read_truth).value_or(false)};
    if (contains(seen, result.name)) row.entry("name").refuse("another name than the classes before");
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
  if (const auto corners = table.optional("crop", Corners{})) labels.crop = {corners->first, corners->second};
  table.know({"keep"});
  if (table.has("keep")) read_keep(table.entry("keep"), labels);
  labels.scale = read_scale(table);
  labels.frame = table.optional("frame", read_name<Frame>).value_or(labels.frame);
  if (labels.frame == Frame::world && labels.file.path.substr(labels.file.path.rfind('.')) == ".inv3")
    table.entry("frame").refuse(
        "\"grid\" with a project of InVesalius, whose place in the scanner is not read; "
        "NIfTI files have world coordinates");
  return labels;
}

NamedFile read_surface_name(const Entry& entry, const std::string& case_path) {
  return read_file_name(entry, {".stl", ".obj", ".ply", ".vtp"},
                        "a closed surface, .stl, .obj, .ply or .vtp; a mesh of cells is shape = \"mesh\"",
                        case_path);
}

MeshFile read_mesh_file(Table& table, const std::string& case_path) {
  const Entry entry = table.entry("file");
  MeshFile mesh{
      read_file_name(entry, {".msh", ".geo", ".vtu", ".vtk"},
                     "a mesh of gmsh's, .msh or .geo, or of VTK's, .vtu or .vtk; a closed surface in "
                     "STL, OBJ, PLY or VTP is shape = \"surface\", and meshio converts other meshes "
                     "(meshio convert FILE body.vtu)",
                     case_path),
      read_scale(table)};
  const std::string ending = mesh.file.path.substr(mesh.file.path.rfind('.'));
  table.refuse_unless(ending == ".vtu" || ending == ".vtk", {"groups"},
                      "left out: the groups of a gmsh file are its physical groups");
  mesh.cell_groups = table.optional("groups", read_text).value_or("");
  return mesh;
}

FilledSurface read_filled_surface(Table& table, const std::string& case_path) {
  FilledSurface surface;
  surface.file = read_surface_name(table.entry("file"), case_path);
  surface.fill = table.optional("fill", read_name<Fill>).value_or(surface.fill);
  surface.size =
      table.required("size", Number{"a number above 0 (mm), the length of a cell's edges", is_positive});
  surface.scale = read_scale(table);
  return surface;
}

/// A modulus, MPa. The limits leave room for its squares and cubes.
const Number modulus{"a number above 0 (MPa), from 1e-12 to 1e12",
                     [](double value) { return value >= 1e-12 && value <= 1e12; }};

void read_keys(Table& table, LinearElastic& m) {
  m.youngs_modulus = table.required("youngs_modulus", modulus);
  m.poissons_ratio = table.required(
      "poissons_ratio", Number{"a number above -1 and below 0.5 (at 0.5 the bulk modulus is infinite: "
                               "model = \"ogden\" is for incompressible materials)",
                               is_poissons_ratio});
}

void read_keys(Table& table, Ogden& material) {
  const Entry mu = table.entry("mu");
  material.mu = Numbers{"one or more finite numbers (MPa)", 0}(mu);
  if (!modulus.condition(std::accumulate(material.mu.begin(), material.mu.end(), 0.0)))
    mu.refuse("numbers with a sum above 0 (MPa), from 1e-12 to 1e12: the sum is the initial shear modulus");
  const Entry alpha = table.entry("alpha");
  material.alpha = Numbers{"as many finite numbers as mu, none 0", 0, [](double a) { return a != 0; }}(alpha);
  if (material.alpha.size() != material.mu.size())
    alpha.refuse("as many numbers as mu has, which is {}", material.mu.size());
  material.bulk_modulus = table.optional("bulk_modulus", modulus);
}

void read_keys(Table& table, Yeoh& m) {
  table.know({"c20", "c30"}); // no slips of a missing c10
  m.c10 = table.required("c10",
                         Number{"a number above 0 (MPa), from 1e-12 to 1e12: half the initial shear modulus",
                                modulus.condition});
  const Number coefficient{"a finite number (MPa)"};
  m.c20 = table.optional("c20", coefficient).value_or(0);
  m.c30 = table.optional("c30", coefficient).value_or(0);
  m.bulk_modulus = table.optional("bulk_modulus", modulus);
}

/// The compliance is positive definite when every modulus is positive, |nu_TT| < 1 and
/// 1 - nu_TT - 2 nu_LT² E_T/E_L > 0 (Lempriere 1968, AIAA J 6:2226).
void read_keys(Table& table, TransverselyIsotropic& m) {
  m.youngs_modulus_along = table.required("youngs_modulus_along", modulus);
  m.youngs_modulus_across = table.required("youngs_modulus_across", modulus);
  m.shear_modulus_along = table.required("shear_modulus_along", modulus);
  m.poissons_ratio_across = table.required("poissons_ratio_across",
                                           Number{"a number above -1 and below 1 (outside, a strain across "
                                                  "the fibre would store no energy)",
                                                  [](double nu) { return nu > -1 && nu < 1; }});
  const double bound =
      std::sqrt((1 - m.poissons_ratio_across) * m.youngs_modulus_along / (2 * m.youngs_modulus_across));
  m.poissons_ratio_along = table.required(
      "poissons_ratio_along",
      Number{fmt::format("a number between -b and b = {:.6g}, b² = (1 - poissons_ratio_across) "
                         "youngs_modulus_along/(2 youngs_modulus_across) (outside, a strain would store no "
                         "energy)",
                         bound),
             [=](double nu) { return std::abs(nu) < bound; }});
  m.fibre = table.required("fibre", read_direction);
}

/// @param model  "neo_hookean" or "mooney_rivlin"
Ogden read_mooney_rivlin(Table& table, const std::string& model) {
  if (model == "neo_hookean") {
    const double shear_modulus = table.required("shear_modulus", modulus);
    return mooney_rivlin(shear_modulus / 2, 0, table.optional("bulk_modulus", modulus));
  }
  const Number coefficient{"a finite number (MPa)"};
  const double c10 = table.required("c10", coefficient), c01 = table.required("c01", coefficient);
  if (!modulus.condition(2 * (c10 + c01)))
    table.entry("c01").refuse(
        "a number for which 2 (c10 + c01), the initial shear modulus, is above 0 (MPa), "
        "from 1e-12 to 1e12");
  return mooney_rivlin(c10, c01, table.optional("bulk_modulus", modulus));
}

Material read_material(Table& table) {
  const Entry model = table.entry("model");
  std::vector<std::string> names = Kinds<Material>::names();
  names.insert(names.end(), {"neo_hookean", "mooney_rivlin"});
  if (const std::string name = model.word(names); !contains(Kinds<Material>::names(), name))
    return read_mooney_rivlin(table, name);
  auto material = table.required("model", read_kind<Material>);
  std::visit([&](auto& kind) { read_keys(table, kind); }, material);
  return material;
}

/// Cells between two planes: axis, from, to; either end may be left out.
void read_layer(Table& table, RegionMaterial& region) {
  const int axis = static_cast<int>(table.required("axis", read_name<Axis>));
  const Number position{"a finite number (mm)"};
  const auto from = table.optional("from", position), to = table.optional("to", position);
  if (!from && !to) table.entry("from").refuse("a finite number (mm), here or for to: where the layer ends");
  region.lower[axis] = from.value_or(region.lower[axis]);
  region.upper[axis] = to.value_or(region.upper[axis]);
  if (!(region.lower[axis] < region.upper[axis])) table.entry("to").refuse("a number above from");
}

/// A material and the cells that consist of it, in a case whose own material is read.
RegionMaterial read_region_material(Table& table, const Case& definition) {
  const Material& own = definition.material;
  RegionMaterial region;
  region.where = table.where();
  const Labels* labels = std::get_if<Labels>(&definition.body);
  const bool has_group = table.has("group") || table.has("class"), has_box = table.has("box"),
             has_axis = table.has("axis");
  if (has_group + has_box + has_axis != 1)
    table.entry("axis").refuse(
        "one of class, group, box, or axis with from and to: which cells are of this material");
  table.refuse_unless(std::holds_alternative<MeshFile>(definition.body), {"group"},
                      "left out: only a body of shape = \"mesh\" has physical groups");
  table.refuse_unless(labels != nullptr, {"class"},
                      "left out: only a body of shape = \"labels\" has classes of cells");
  region.group = table.optional(labels ? "class" : "group", read_text).value_or("");
  if (labels && has_group) table.entry("class").word(names_of(labels->classes));
  table.know({"box", "axis"});
  if (has_box) std::tie(region.lower, region.upper) = table.required("box", Corners{});
  if (has_axis) read_layer(table, region);
  table.refuse_unless(has_axis, {"from", "to"}, "left out without axis");
  region.material = read_material(table);
  if (region.material.index() != own.index())
    table.entry("model").refuse(
        fmt::format("\"{}\" as in [material]: one formulation serves the whole body", name_of(own)));
  region.dynamics = read_material_dynamics(table, definition.dynamics.has_value());
  return region;
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
  const std::string shape =
      table.entry("shape").word({"box", "mesh", "voxels", "labels", "surface", "network"});
  table.refuse_unless(shape == "labels", {"frame"},
                      "left out: only the picture of shape = \"labels\" has world coordinates");
  if (shape == "network")
    return Network{read_file_name(table.entry("nodes"), {".csv"}, "a file of nodes, .csv", case_path),
                   read_file_name(table.entry("springs"), {".csv"}, "a file of springs, .csv", case_path)};
  if (shape == "box") return read_box(table);
  if (shape == "labels") return read_labels(table, case_path);
  if (shape == "mesh") return read_mesh_file(table, case_path);
  if (shape == "surface") return read_filled_surface(table, case_path);
  return Voxels{read_surface_name(table.entry("surface"), case_path),
                table.required("edge", Number{"a number above 0 (mm), the edge of a cell", is_positive}),
                read_scale(table)};
}

void read_materials(Table& root, Case& result) {
  if (!has_finite_elements(result)) {
    root.know({"region_material"}); // refused with a network's other tables
    result.material_dynamics = root.optional_section("material", [&](Table& table) {
      table.refuse_unless(false, {"model", "density"},
                          "left out: springs of a network have no material, and its masses are a column of "
                          "body.nodes; [fem.body] has a material");
      return read_material_dynamics(table, result.dynamics.has_value());
    });
    return;
  }
  result.material = root.section("material", [&](Table& table) {
    Material material = read_material(table);
    result.material_dynamics = read_material_dynamics(table, result.dynamics.has_value());
    return material;
  });
  result.region_materials =
      root.sections("region_material", [&](Table& table) { return read_region_material(table, result); });
}

} // namespace springproof::cases
