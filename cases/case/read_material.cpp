#include "cases/case/read_material.hpp"

#include "cases/case/read_models.hpp"

#include <fmt/format.h>
#include <limits>
#include <numeric>

namespace springproof::cases {

namespace {

LinearElastic read_linear_elastic(Table& table) {
  LinearElastic material{};
  material.youngs_modulus = table.required("youngs_modulus", Number{"a number above 0 (MPa)", is_positive});
  material.poissons_ratio = table.required(
      "poissons_ratio", Number{"a number above -1 and below 0.5 (at 0.5 the bulk modulus is infinite: "
                               "model = \"ogden\" is for incompressible materials)",
                               [](double nu) { return nu > -1 && nu < 0.5; }});
  return material;
}

Ogden read_ogden(Table& table) {
  Ogden material;
  const Entry mu = table.entry("mu");
  material.mu = Numbers{"one or more finite numbers (MPa)", 0}(mu);
  if (!(std::accumulate(material.mu.begin(), material.mu.end(), 0.0) > 0))
    mu.refuse("numbers with a sum above 0 (MPa): the sum is the initial shear modulus");
  const Entry alpha = table.entry("alpha");
  material.alpha = Numbers{"as many finite numbers as mu, none 0", 0, [](double a) { return a != 0; }}(alpha);
  if (material.alpha.size() != material.mu.size())
    alpha.refuse(fmt::format("as many numbers as mu has, which is {}", material.mu.size()));
  material.bulk_modulus = table.optional("bulk_modulus", Number{"a number above 0 (MPa)", is_positive});
  return material;
}

const char* model_name(const Material& material) {
  return std::holds_alternative<Ogden>(material) ? "ogden" : "linear_elastic";
}

/// Cells between two planes: axis, from, to; either end may be left out.
void read_layer(Table& table, RegionMaterial& region) {
  const int axis = static_cast<int>(table.required("axis", read_name<Axis>));
  const Number position{"a finite number (mm)"};
  const auto from = table.optional("from", position), to = table.optional("to", position);
  if (!from && !to) table.entry("from").refuse("a finite number (mm), here or for to: where the layer ends");
  if (from) region.lower[axis] = *from;
  if (to) region.upper[axis] = *to;
  if (from && to && !(*from < *to)) table.entry("to").refuse("a number above from");
}

void read_box(const Entry& entry, RegionMaterial& region) {
  const std::string allowed = "two corners, the lower first: [[x, y, z], [x, y, z]] (mm)";
  const std::vector<Entry> corners = entry.elements(allowed);
  if (corners.size() != 2) entry.refuse(allowed);
  region.lower = Vector{allowed}(corners[0]);
  region.upper = Vector{allowed}(corners[1]);
  if (!(region.lower.array() < region.upper.array()).all()) entry.refuse(allowed);
}

} // namespace

Material read_material(Table& table) {
  const Entry entry = table.entry("model");
  const auto model = entry.node ? entry.node->value_exact<std::string>() : std::nullopt;
  if (model == "linear_elastic") return read_linear_elastic(table);
  if (model == "ogden") return read_ogden(table);
  entry.refuse_word({"linear_elastic", "ogden"});
}

RegionMaterial read_region_material(Table& table, const Material& own, const Body& body) {
  RegionMaterial region;
  region.where = table.where();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  region.lower.setConstant(-infinity);
  region.upper.setConstant(infinity);
  const bool has_group = table.has("group"), has_box = table.has("box"), has_axis = table.has("axis");
  if (has_group + has_box + has_axis != 1)
    table.entry("axis").refuse(
        "one of group, box, or axis with from and to: which cells are of this material");
  if (has_group) {
    const Entry entry = table.entry("group");
    if (!std::holds_alternative<MeshFile>(body))
      entry.refuse("left out: only a body of shape = \"mesh\" has physical groups");
    region.group = read_text(entry);
  }
  if (has_box) read_box(table.entry("box"), region);
  if (has_axis) read_layer(table, region);
  for (const char* key : {"group", "box", "axis", "from", "to"})
    table.optional(key, [](const Entry&) { return 0; }); // known, though absent
  for (const char* key : {"from", "to"})
    if (!has_axis && table.has(key)) table.entry(key).refuse("left out without axis");
  region.material = read_material(table);
  if (region.material.index() != own.index())
    table.entry("model").refuse(
        fmt::format("\"{}\" as in [material]: one formulation serves the whole body", model_name(own)));
  return region;
}

void check_region_materials(const Case& definition) {
  if (definition.region_materials.empty()) return;
  const Where& where = definition.region_materials.front().where;
  if (definition.msm.design == Design::given)
    throw InputError(
        where,
        "must be left out beside msm.design = \"given\", which gives one set of springs for all cells");
  for (const RegionMaterial& region : definition.region_materials) {
    check_element(definition.fem, region.material, region.where);
    check_design_ratio(definition.msm, region.material, region.where);
  }
}

} // namespace springproof::cases
