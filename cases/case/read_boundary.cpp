#include "cases/case/readers.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace springproof::cases {

namespace {

const Vector read_point{"a point of three finite numbers (mm)"},
    read_force{"a force of three finite numbers (N)"};
const Number read_tolerance{"a number above 0 (mm)", is_positive};

/// Reads "near 5 5 10".
Eigen::Vector3d read_near_words(const Entry& entry, const std::string& text) {
  std::istringstream stream(text);
  std::string near;
  Eigen::Vector3d point;
  stream >> near >> point.x() >> point.y() >> point.z();
  if (!stream || !point.allFinite() || words_of(text).size() != 4 || !(stream >> std::ws).eof())
    entry.refuse("\"near x y z\" with three finite numbers (mm)");
  return point;
}

/// Names of a box's faces, no two of which are the same or face each other.
void check_box_region(const Entry& entry, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (!contains(face_names, word))
      entry.refuse("a face " + alternatives(face_names) +
                   " of the box, two joined by a blank for an edge, three for a vertex, or \"near x y z\"");
    for (const std::string& other : words)
      if (&other != &word && other[0] == word[0])
        entry.refuse("faces that meet: {} and {} do not", word, other);
  }
}

std::array<bool, 3> read_components(const Entry& entry) {
  const std::string allowed = "one to three of \"x\", \"y\", \"z\", each once";
  std::array<bool, 3> components{};
  for (const Entry& element : entry.elements(allowed)) {
    const auto text = element.value<std::string>();
    const auto axis = text ? value_of<Axis>(*text) : std::nullopt;
    if (!axis || components[static_cast<std::size_t>(*axis)]) entry.refuse(allowed);
    components[static_cast<std::size_t>(*axis)] = true;
  }
  return components;
}

/// Reads { point = [...], normal = [...], tolerance = 0.1 }: the faces of the surface on a plane.
Region read_plane(Table& table) {
  Plane plane;
  plane.point = table.required("point", read_point);
  plane.normal = table.required("normal", read_direction);
  plane.tolerance = table.required("tolerance", read_tolerance);
  return {fmt::format("plane through ({}) across ({}) to {} mm", fmt::join(plane.point, ", "),
                      fmt::join(plane.normal, ", "), plane.tolerance),
          std::nullopt,
          table.where(),
          std::nullopt,
          std::nullopt,
          std::nullopt,
          plane};
}

/// Reads { class = "bone", box = [[...], [...]], beyond = { point = [...], normal = [...] } }.
Region read_part(const Entry& entry, const Body& body) {
  const std::string allowed =
      "the name of a region, or a table with plane, or with one or more of class, box and beyond";
  Table table(entry, allowed);
  if (table.has("plane")) {
    Region on_plane = table.section("plane", read_plane);
    on_plane.where = entry.where;
    table.refuse_unless(false, {"class", "box", "beyond"}, "left out beside plane");
    table.refuse_unknown_keys();
    return on_plane;
  }
  table.know({"plane"});
  Region region{"", std::nullopt, entry.where};
  Part& part = region.part.emplace();
  const Labels* labels = std::get_if<Labels>(&body);
  table.refuse_unless(labels != nullptr || std::holds_alternative<MeshFile>(body), {"class"},
                      "left out: only a body of shape = \"labels\" or \"mesh\" has classes of cells");
  part.cell_class = table.optional("class", read_text).value_or("");
  if (labels != nullptr && !part.cell_class.empty()) table.entry("class").word(names_of(labels->classes));
  region.name = part.cell_class.empty() ? "nodes" : "nodes of " + part.cell_class;
  if (const auto box = table.optional("box", Corners{true})) {
    std::tie(part.lower, part.upper) = *box;
    region.name +=
        fmt::format(" between ({}) and ({})", fmt::join(part.lower, ", "), fmt::join(part.upper, ", "));
  }
  const auto read_plane = [](Table& plane) {
    return std::pair{plane.required("point", read_point), plane.required("normal", read_direction)};
  };
  if (const auto plane = table.section_if_there("beyond", read_plane)) {
    std::tie(part.point, part.normal) = *plane;
    region.name +=
        fmt::format(" beyond ({}) towards ({})", fmt::join(part.point, ", "), fmt::join(part.normal, ", "));
  }
  table.refuse_unknown_keys();
  if (!table.has("class") && !table.has("box") && !table.has("beyond")) entry.refuse(allowed);
  return region;
}

/// A load over an area needs a region with an area: of a box's regions, a face. Groups of a mesh are checked
/// when it is read.
void check_has_area(const Load& load, const Body& body) {
  const Region& region = load.region;
  const bool has_area =
      region.is_patch() || (!region.part && !region.near &&
                            (std::holds_alternative<MeshFile>(body) || words_of(region.name).size() == 1));
  if (!has_area)
    refuse(load.region.where,
           "has no area, and a {} acts on an area; must be one face, such as \"z+\", near with radius, or a "
           "plane",
           name_of(load.kind));
}

Fixed read_fixed(Table& table, const Body& body) {
  Fixed fixed;
  fixed.region = read_region(table, body);
  fixed.components = table.optional("components", read_components).value_or(fixed.components);
  return fixed;
}

Fixed read_symmetry(Table& table) {
  const Entry entry = table.entry("plane");
  const std::string face = entry.word(face_names);
  return {{face, std::nullopt, entry.where}, {face[0] == 'x', face[0] == 'y', face[0] == 'z'}};
}

/// Reads { point = [...], normal = [...], length = 10 }.
ScaledDisplacement read_scaled(Table& table) {
  ScaledDisplacement scaled;
  scaled.where = table.where();
  scaled.point = table.required("point", read_point);
  scaled.normal = table.required("normal", read_direction);
  scaled.length = table.required(
      "length", Number{"a number above 0 (mm), the length of the zone that is scaled", is_positive});
  return scaled;
}

/// Reads how the region moves: where its motion fades out, and in how many steps of the load.
void read_way(Table& table, Moved& moved, const std::optional<Dynamics>& dynamics) {
  table.refuse_unless(!dynamics, {"steps"}, "left out in a dynamic case, whose steps are those of time");
  moved.steps = table.optional("steps", WholeNumber{"a whole number from 1 to 1000", 1, 1000}).value_or(1);
  moved.scaled = table.section_if_there("scaled_displacement", read_scaled);
  if (!moved.scaled) return;
  const auto [least, most] =
      dynamics ? moved.history.factors_between(0, dynamics->end) : std::array<double, 2>{0, 1};
  const double nearer_at_full = -moved.displacement.dot(moved.scaled->normal),
               nearer = std::max(least * nearer_at_full, most * nearer_at_full);
  if (!(nearer < moved.scaled->length))
    refuse(moved.scaled->where,
           "length is {} mm, must be more than the {} mm by which the displacement shortens the zone{}",
           moved.scaled->length, nearer, dynamics ? " at some time of its history" : "");
}

Moved read_moved(Table& table, const Case& definition) {
  Moved moved;
  moved.region = read_region(table, definition.body);
  moved.history = read_history(table, definition.dynamics.has_value());
  const bool is_turned = table.has("angle");
  table.know({"angle"});
  table.refuse_unless(!is_turned, {"displacement", "components"},
                      "left out beside angle: a region is shifted or turned, not both");
  table.refuse_unless(is_turned, {"axis", "centre"}, "left out without angle");
  if (is_turned) {
    moved.angle = table.required(
        "angle", Number{"a number other than 0 (degrees)", [](double angle) { return angle != 0; }});
    moved.axis = table.required("axis", read_direction);
    moved.centre = table.required("centre", read_point);
  } else {
    moved.components = table.optional("components", read_components).value_or(moved.components);
    const Entry entry = table.entry("displacement");
    moved.displacement = Vector{"three finite numbers (mm), or angle, axis and centre in its place"}(entry);
    for (std::size_t a = 0; a < 3; ++a)
      if (!moved.components[a] && !is_in_world(definition.body) &&
          moved.displacement[static_cast<int>(a)] != 0)
        entry.refuse("0 in the components that are not moved");
  }
  read_way(table, moved, definition.dynamics);
  return moved;
}

void read_keys(Table& table, loads::NodalForce& force) {
  force.value = table.required("value", read_force);
}

void read_keys(Table& table, loads::TotalForce& force) {
  force.value = table.required("value", read_force);
}

void read_keys(Table& table, loads::Traction& traction) {
  traction.value = table.required("value", Vector{"a traction of three finite numbers (MPa)"});
}

void read_keys(Table& table, loads::Torque& torque) {
  torque.value = table.required("value", Number{"one finite number, the moment (N mm)"});
  torque.axis = table.required("axis", read_direction);
  torque.centre = table.required("centre", read_point);
}

void read_keys(Table& table, loads::Gravity& gravity) {
  table.refuse_unless(false, {"region", "near", "radius"}, "left out: gravity acts on the whole body");
  gravity.value = table.required("value", Vector{"an acceleration of three finite numbers (m/s²)"});
}

Load read_load(Table& table, const Case& definition) {
  Load load;
  load.kind = table.required("kind", read_kind<loads::Kind>);
  if (load.on() == loads::On::masses)
    load.region.where = table.entry("kind").where; // messages point there
  else
    load.region = read_region(table, definition.body);
  load.history = read_history(table, definition.dynamics.has_value());
  std::visit([&](auto& kind) { read_keys(table, kind); }, load.kind);
  if (load.on() == loads::On::area) check_has_area(load, definition.body);
  return load;
}

AddedMass read_mass(Table& table, const Body& body) {
  const auto is_mass = [](double mass) { return mass >= 1e-9 && mass <= 1e6; };
  return {read_region(table, body),
          table.required("value", Number{"a number from 1e-9 to 1000000 (kg)", is_mass})};
}

} // namespace

Eigen::Vector3d read_direction(const Entry& entry) {
  if (entry.node && entry.node->is_string())
    return Eigen::Vector3d::Unit(static_cast<int>(read_name<Axis>(entry)));
  const std::string allowed = "\"x\" | \"y\" | \"z\" or a direction of three numbers, not all 0";
  const Eigen::Vector3d direction = Vector{allowed}(entry);
  if (!(direction.stableNorm() > 0)) entry.refuse(allowed);
  return direction.stableNormalized();
}

Region read_nearest(Table& table) {
  table.refuse_unless(false, {"region", "near", "radius"},
                      "left out beside nearest: they say the same thing twice");
  const Entry nearest = table.entry("nearest");
  Region region{"", read_point(nearest), nearest.where};
  region.tolerance = table.required("tolerance", read_tolerance);
  return region;
}

Region read_region_text(const Entry& entry, const Body& body) {
  const std::string text = read_text(entry);
  const std::vector<std::string> words = words_of(text);
  if (words.front() == "near") return {"", read_near_words(entry, text), entry.where};
  if (!std::holds_alternative<MeshFile>(body)) check_box_region(entry, words);
  return {text, std::nullopt, entry.where};
}

Region read_region_entry(const Entry& entry, const Body& body) {
  return entry.node && entry.node->is_table() ? read_part(entry, body) : read_region_text(entry, body);
}

Region read_region(Table& table, const Body& body) {
  if (table.has("nearest")) return read_nearest(table);
  table.refuse_unless(false, {"tolerance"}, "left out without nearest, from whose point it is the distance");
  if (!table.has("near")) {
    const Entry entry = table.entry("region");
    table.know({"near", "nearest"});
    table.refuse_unless(false, {"radius"}, "left out without near, whose patch it is the radius of");
    return read_region_entry(entry, body);
  }
  table.refuse_unless(!table.has("region"), {"near"},
                      "left out beside region: they say the same thing twice");
  const Entry near = table.entry("near");
  Region region{"", read_point(near), near.where};
  region.radius = table.optional("radius", Number{"a number above 0 (mm)", is_positive});
  if (region.radius)
    region.name = fmt::format("within {} of ({}, {}, {})", *region.radius, region.near->x(), region.near->y(),
                              region.near->z());
  return region;
}

void read_boundary(Table& root, Case& result) {
  const auto with_body = [&](auto read) {
    return [&, read](Table& table) { return read(table, result.body); };
  };
  result.fixed = root.sections("fixed", with_body(read_fixed));
  result.symmetry = root.sections("symmetry", read_symmetry);
  for (std::size_t i = 0; i < result.symmetry.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const Region& plane = result.symmetry[i].region; plane.name == result.symmetry[j].region.name)
        refuse(plane.where, "is \"{}\", must be another plane than symmetry[{}]", plane.name, j);
  result.masses = root.sections("mass", with_body(read_mass));
  result.moved = root.sections("moved", [&](Table& table) { return read_moved(table, result); });
  result.loads = root.sections("load", [&](Table& table) { return read_load(table, result); });
}

void check_boundary(Table& root, const Case& result) {
  const bool may_fly = result.dynamics && result.dynamics->start == MotionStart::rest;
  const bool is_held = rigid_class(result.body) != nullptr || root.has("moved");
  if (result.fixed.empty() && result.symmetry.empty() && !is_held && !may_fly)
    root.entry("fixed").refuse("one or more tables [[fixed]] or [[symmetry]]: nothing holds the body");
  const auto has_begun = [&](const History& history) { // before the end
    if (!result.dynamics ||
        (result.dynamics->start == MotionStart::equilibrium && history.just_before(0) != 0))
      return true;
    const auto [least, most] = history.factors_between(0, result.dynamics->end);
    return least != 0 || most != 0;
  };
  const auto moves = [](const Moved& moved) { return moved.angle != 0 || !moved.displacement.isZero(0); };
  const auto refuse_late = [&](const char* list) {
    Table first(root.entry(list).elements("tables").front(), "a table");
    first.entry("history").refuse("other than 0 at some time from 0 to the end, {} s, here or in another "
                                  "[[load]] or [[moved]]: nothing would move",
                                  result.dynamics->end);
  };
  const auto& moved = result.moved;
  const auto& loads = result.loads;
  const bool has_moves = std::any_of(moved.begin(), moved.end(), moves);
  if (std::any_of(moved.begin(), moved.end(),
                  [&](const Moved& one) { return moves(one) && has_begun(one.history); }))
    return;
  if (std::any_of(result.tools.begin(), result.tools.end(), [&](const Tool& tool) {
        return tool.moves() && (!tool.path.empty() || has_begun(tool.history));
      }))
    return;
  if (loads.empty() && has_moves) refuse_late("moved");
  if (loads.empty())
    root.entry("load").refuse("one or more tables [[load]] or [[moved]], or [[tool]] with a displacement");
  if (std::all_of(loads.begin(), loads.end(), [](const Load& load) { return load.is_zero(); }) &&
      !has_moves) {
    Table first(root.entry("load").elements("tables").front(), "a table");
    first.entry("value").refuse("other than 0, here or in another [[load]]: nothing would move");
  }
  if (std::none_of(loads.begin(), loads.end(),
                   [&](const Load& load) { return !load.is_zero() && has_begun(load.history); }))
    refuse_late(has_moves ? "moved" : "load");
}

void check_turns(const Case& definition) {
  if (definition.fem.formulation != Formulation::small_strain) return;
  for (const Moved& moved : definition.moved)
    if (const double degrees = std::abs(moved.angle) * largest_factor(moved, definition.dynamics);
        !(degrees <= largest_turn_of_small_strain))
      refuse(moved.region.where,
             "is turned by {} degrees, must be at most {} beside fem.formulation = \"small_strain\", which "
             "knows nothing of the way there",
             degrees, largest_turn_of_small_strain);
}

} // namespace springproof::cases
