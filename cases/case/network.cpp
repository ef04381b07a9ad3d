#include "cases/case/readers.hpp"

#include <fmt/format.h>

namespace springproof::cases {

namespace {

/// A region of nodes alone: a network has no faces and no cells.
void check_region(const Region& region) {
  if (region.is_patch())
    throw InputError(region.where, "is a patch of faces, and a network has none; must be nodes: one at near, "
                                   "one nearest to a point, those on a face of the bounding box such as "
                                   "\"z+\", or a table with box or beyond");
  if (region.is_in_cell)
    throw InputError(region.where, "is a point of a cell, and a network has none; must be a node: give its "
                                   "place to node = \"near X Y Z\", or to nearest with a tolerance");
}

void check_load(const Load& load) {
  check_region(load.region);
  if (load.on() == loads::On::area)
    refuse(
        load.region.where,
        "is a region of a {}, which acts on faces, and a network has none; must be one of a nodal_force or "
        "a total_force",
        name_of(load.kind));
}

void check_measure(const Measure& measure, bool is_interpolated) {
  namespace m = measures;
  for_each_region(measure, [](const Region& region, bool) { check_region(region); });
  const auto refuse_kind = [&](const char* reason) {
    refuse(measure.where,
           "kind is \"{}\", {}; must be one of nodes, such as \"displacement\", or "
           "\"displacement_field_max\"{}",
           name_of(measure.kind), reason, is_interpolated ? "" : ", \"reaction\" or \"strain_energy\"");
  };
  if (is<m::Volume>(measure) || is<m::DisplacementFieldL2>(measure) || is<m::Stress>(measure) ||
      is<m::Strain>(measure))
    refuse_kind("which is one of cells, and a network has none");
  if (is_interpolated && is_of_fields(measure.kind))
    refuse_kind("which the displacement of [fem.body] at the network's nodes does not tell");
}

} // namespace

void refuse_network(const Case& definition, const std::string& what, const std::string& instead) {
  if (const Network* network = std::get_if<Network>(&definition.body))
    refuse(network->nodes.where, "the body is a network, which has no cells for {}; {}", what, instead);
}

void check_finite_elements(const Case& definition) {
  if (!has_finite_elements(definition))
    refuse_network(definition, "finite elements",
                   "run --only msm solves its springs by themselves, and a table [fem.body] gives the finite "
                   "elements a body of their own");
}

std::optional<Body> read_fem_body(Table& root, const Case& definition) {
  if (!root.has("fem")) return std::nullopt;
  const Entry entry = root.entry("fem");
  Table fem(entry, "a table [fem]");
  fem.refuse_unless(!has_cells(definition.body), {"body"},
                    "left out: both models are made of [body], unless that is a network");
  const auto body = fem.section_if_there("body", [&](Table& table) {
    Body read = read_body(table, definition.file);
    if (!has_cells(read)) table.entry("shape").refuse("another shape, of cells");
    if (is_in_world(read))
      table.entry("frame").refuse(
          "\"grid\" here: the network's nodes are along the axes of the picture's array");
    return read;
  });
  if (!has_cells(definition.body) && !body)
    throw InputError(entry.where, "must be left out, or have a table [fem.body], the finite elements' own: "
                                  "the body is a network, which has no cells for them");
  return body;
}

void check_network(Table& root, const Case& definition) {
  if (has_cells(definition.body)) return;
  for (const char* table : {"region_material", "surface", "landmark"})
    if (root.has(table))
      throw InputError(root.entry(table).where, "must be left out: a network has no cells for it");
  if (!definition.removed.empty())
    throw InputError(definition.removed.front().where,
                     "must be left out: pieces are removed from cells, and a network has none; take its "
                     "nodes and springs out of the files");
  if (definition.fem_body && definition.dynamics)
    throw InputError(definition.dynamics->where, "must be left out beside [fem.body], whose displacement is "
                                                 "interpolated in statics alone; without [fem] the springs "
                                                 "move by themselves");
  for (const Fixed& fixed : definition.fixed) check_region(fixed.region);
  for (const Moved& moved : definition.moved) check_region(moved.region);
  for (const Load& load : definition.loads) check_load(load);
  for (const AddedMass& mass : definition.masses) check_region(mass.region);
  for (const Measure& measure : definition.measures) check_measure(measure, definition.fem_body.has_value());
}

} // namespace springproof::cases
