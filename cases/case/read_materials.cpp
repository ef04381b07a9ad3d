#include "cases/case/readers.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>

namespace springproof::cases {

namespace {

/// A modulus, MPa. The limits leave room for its squares and cubes.
const Number modulus{"a number above 0 (MPa), from 1e-12 to 1e12",
                     [](double value) { return value >= 1e-12 && value <= 1e12; }};

LinearElastic read_linear_elastic(Table& table) {
  return {table.required("youngs_modulus", modulus),
          table.required("poissons_ratio",
                         Number{"a number above -1 and below 0.5 (at 0.5 the bulk modulus is infinite: "
                                "model = \"ogden\" is for incompressible materials)",
                                is_poissons_ratio})};
}

Ogden read_ogden(Table& table) {
  Ogden material;
  const Entry mu = table.entry("mu");
  material.mu = Numbers{"one or more finite numbers (MPa)", 0}(mu);
  if (!modulus.condition(std::accumulate(material.mu.begin(), material.mu.end(), 0.0)))
    mu.refuse("numbers with a sum above 0 (MPa), from 1e-12 to 1e12: the sum is the initial shear modulus");
  const Entry alpha = table.entry("alpha");
  material.alpha = Numbers{"as many finite numbers as mu, none 0", 0, [](double a) { return a != 0; }}(alpha);
  if (material.alpha.size() != material.mu.size())
    alpha.refuse(fmt::format("as many numbers as mu has, which is {}", material.mu.size()));
  material.bulk_modulus = table.optional("bulk_modulus", modulus);
  return material;
}

/// The compliance is positive definite when every modulus is positive, |nu_TT| < 1 and
/// 1 - nu_TT - 2 nu_LT² E_T/E_L > 0 (Lempriere 1968, AIAA J 6:2226).
TransverselyIsotropic read_transversely_isotropic(Table& table) {
  TransverselyIsotropic m;
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
  return m;
}

Material read_material(Table& table) {
  const std::string model = table.entry("model").word(material_models());
  if (model == "ogden") return read_ogden(table);
  if (model == "transversely_isotropic") return read_transversely_isotropic(table);
  return read_linear_elastic(table);
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
  region.upper.setConstant(std::numeric_limits<double>::infinity());
  region.lower = -region.upper;
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
  if (has_box) {
    const auto [lower, upper] = read_corners(table.entry("box"));
    region.lower = lower;
    region.upper = upper;
  }
  if (has_axis) read_layer(table, region);
  table.know({"box", "axis", "from", "to"});
  table.refuse_unless(has_axis, {"from", "to"}, "left out without axis");
  region.material = read_material(table);
  if (region.material.index() != own.index())
    table.entry("model").refuse(fmt::format("\"{}\" as in [material]: one formulation serves the whole body",
                                            material_models()[own.index()]));
  region.dynamics = read_material_dynamics(table, definition.dynamics.has_value());
  return region;
}

} // namespace

const std::vector<std::string>& material_models() {
  static const std::vector<std::string> names{"linear_elastic", "ogden", "transversely_isotropic"};
  return names;
}

void read_materials(Table& root, Case& result) {
  result.material = root.section("material", [&](Table& table) {
    Material material = read_material(table);
    result.material_dynamics = read_material_dynamics(table, result.dynamics.has_value());
    return material;
  });
  result.region_materials =
      root.sections("region_material", [&](Table& table) { return read_region_material(table, result); });
}

} // namespace springproof::cases
