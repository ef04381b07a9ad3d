#include "cases/case/read_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

namespace springproof::cases {

namespace {

const std::vector<std::string> face_names{"x-", "x+", "y-", "y+", "z-", "z+"};

std::vector<std::string> split(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// "near 5 5 10", split into words.
Eigen::Vector3d read_near_words(const Entry& entry, const std::vector<std::string>& words) {
  const std::string allowed = "\"near x y z\" with three finite numbers (mm)";
  if (words.size() != 4) entry.refuse(allowed);
  Eigen::Vector3d point;
  for (int a = 0; a < 3; ++a) {
    std::istringstream stream(words[static_cast<std::size_t>(a) + 1]);
    if (!(stream >> point[a]) || !stream.eof() || !std::isfinite(point[a])) entry.refuse(allowed);
  }
  return point;
}

/// Names of a box's faces, no two of which are the same or face each other.
void check_box_region(const Entry& entry, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (std::find(face_names.begin(), face_names.end(), word) == face_names.end())
      entry.refuse("a face \"x-\" | \"x+\" | \"y-\" | \"y+\" | \"z-\" | \"z+\" of the box, two joined by a "
                   "blank for an "
                   "edge, three for a vertex, or \"near x y z\"");
    for (const std::string& other : words)
      if (&other != &word && other[0] == word[0])
        entry.refuse(fmt::format("faces that meet: {} and {} do not", word, other));
  }
}

std::array<bool, 3> read_components(const Entry& entry) {
  const std::string allowed = "one to three of \"x\", \"y\", \"z\", each once";
  std::array<bool, 3> components{};
  for (const Entry& element : entry.elements(allowed)) {
    const auto text = element.node->value_exact<std::string>();
    const auto axis = text ? value_of<Axis>(*text) : std::nullopt;
    if (!axis || components[static_cast<std::size_t>(*axis)]) entry.refuse(allowed);
    components[static_cast<std::size_t>(*axis)] = true;
  }
  return components;
}

/// The axis of a torque: "x", "y", "z", or any direction.
Eigen::Vector3d read_direction(const Entry& entry) {
  if (entry.node && entry.node->is_string())
    return Eigen::Vector3d::Unit(static_cast<int>(read_name<Axis>(entry)));
  const std::string allowed = "\"x\" | \"y\" | \"z\" or a direction of three numbers, not all 0";
  const Eigen::Vector3d direction = Vector{allowed}(entry);
  if (!(direction.stableNorm() > 0)) entry.refuse(allowed);
  return direction.stableNormalized();
}

/// A load over an area needs a region with an area: of a box's regions, a face. Groups of a mesh are checked
/// when it is read.
void check_has_area(const Load& load, const Body& body) {
  const bool has_area = load.region.near
                            ? load.region.radius.has_value()
                            : std::holds_alternative<MeshFile>(body) || n_box_faces(load.region) == 1;
  if (!has_area)
    throw InputError(
        load.region.where,
        fmt::format(
            "has no area, and a {} acts on an area; must be one face, such as \"z+\", or near with radius",
            name_of(load.kind)));
}

} // namespace

int n_box_faces(const Region& region) {
  return static_cast<int>(split(region.name).size());
}

Region read_region_text(const Entry& entry, const Body& body) {
  const std::string text = read_text(entry);
  const std::vector<std::string> words = split(text);
  if (words.front() == "near") return {"", read_near_words(entry, words), entry.where};
  if (!std::holds_alternative<MeshFile>(body)) check_box_region(entry, words);
  return {text, std::nullopt, entry.where};
}

Region read_region(Table& table, const Body& body) {
  if (!table.has("near")) {
    Region region = read_region_text(table.entry("region"), body);
    table.optional("near", read_text); // known, though absent
    if (table.has("radius"))
      table.entry("radius").refuse("left out without near, whose patch it is the radius of");
    return region;
  }
  if (table.has("region"))
    table.entry("near").refuse("left out beside region: they say the same thing twice");
  const Entry near = table.entry("near");
  Region region{"", Vector{"a point of three finite numbers (mm)"}(near), near.where};
  region.radius = table.optional("radius", Number{"a number above 0 (mm)", is_positive});
  if (region.radius)
    region.name = fmt::format("within {} of ({}, {}, {})", *region.radius, region.near->x(), region.near->y(),
                              region.near->z());
  return region;
}

Fixed read_fixed(Table& table, const Body& body) {
  Fixed fixed;
  fixed.region = read_region(table, body);
  fixed.components =
      table.optional("components", read_components).value_or(std::array<bool, 3>{true, true, true});
  return fixed;
}

Fixed read_symmetry(Table& table, const Body&) {
  const Entry entry = table.entry("plane");
  const auto text = entry.node ? entry.node->value_exact<std::string>() : std::nullopt;
  if (!text || std::find(face_names.begin(), face_names.end(), *text) == face_names.end())
    entry.refuse_word(face_names);
  Fixed fixed{{*text, std::nullopt, entry.where}, {false, false, false}};
  fixed.components[static_cast<std::size_t>((*text)[0] - 'x')] = true;
  return fixed;
}

Moved read_moved(Table& table, const Body& body) {
  Moved moved;
  moved.region = read_region(table, body);
  const bool is_turned = table.has("angle");
  for (const char* key : {"displacement", "components"})
    if (is_turned && table.has(key))
      table.entry(key).refuse("left out beside angle: a region is shifted or turned, not both");
  for (const char* key : {"axis", "centre"})
    if (!is_turned && table.has(key)) table.entry(key).refuse("left out without angle");
  if (is_turned) {
    moved.angle = table.required(
        "angle", Number{"a number other than 0 (degrees)", [](double angle) { return angle != 0; }});
    moved.axis = table.required("axis", read_direction);
    moved.centre = table.required("centre", Vector{"a point of three finite numbers (mm)"});
  } else {
    moved.components = table.optional("components", read_components).value_or(moved.components);
    const Entry entry = table.entry("displacement");
    moved.displacement = Vector{"three finite numbers (mm), or angle, axis and centre in its place"}(entry);
    for (std::size_t a = 0; a < 3; ++a)
      if (!moved.components[a] && moved.displacement[static_cast<int>(a)] != 0)
        entry.refuse("0 in the components that are not moved");
    table.optional("angle", read_text); // known, though absent
  }
  return moved;
}

Load read_load(Table& table, const Body& body) {
  Load load;
  load.region = read_region(table, body);
  load.kind = table.required("kind", read_name<LoadKind>);
  switch (load.kind) {
  case LoadKind::nodal_force:
  case LoadKind::total_force:
    load.value = table.required("value", Vector{"a force of three finite numbers (N)"});
    break;
  case LoadKind::traction:
    load.value = table.required("value", Vector{"a traction of three finite numbers (MPa)"});
    check_has_area(load, body);
    break;
  case LoadKind::torque:
    load.moment = table.required("value", Number{"one finite number, the moment (N mm)"});
    load.axis = table.required("axis", read_direction);
    load.centre = table.required("centre", Vector{"a point of three finite numbers (mm)"});
    check_has_area(load, body);
    break;
  }
  return load;
}

} // namespace springproof::cases
