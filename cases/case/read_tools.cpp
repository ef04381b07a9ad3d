#include "cases/case/readers.hpp"

namespace springproof::cases {

namespace {

/// The keys of a tool's shape.
struct ToolKeys {
  Table& table;
  Tool& tool;
  const std::string& case_path;

  void operator()(tools::Sphere& sphere) const {
    read_place("centre");
    sphere.radius = radius();
    leave_out({"axis", "file", "normal", "point", "scale"}, "sphere");
  }
  void operator()(tools::Cylinder& cylinder) const {
    read_place("centre");
    cylinder.radius = radius();
    cylinder.axis = table.required("axis", read_direction);
    leave_out({"file", "normal", "point", "scale"}, "cylinder");
  }
  void operator()(tools::Punch& punch) const {
    read_place("centre");
    punch.radius = radius();
    punch.axis = table.required("axis", read_direction);
    leave_out({"file", "normal", "point", "scale"}, "punch");
  }
  void operator()(tools::Plane& plane) const {
    read_place("point");
    plane.normal = table.required("normal", read_direction);
    leave_out({"axis", "centre", "file", "radius", "scale"}, "plane");
  }
  void operator()(tools::Surface& surface) const {
    table.know({"centre"});
    if (table.has("centre") || table.has("path")) read_place("centre");
    surface.file = read_file_name(table.entry("file"), {".stl", ".obj", ".ply", ".vtp"},
                                  "a closed surface, .stl, .obj, .ply or .vtp", case_path);
    surface.scale = read_scale(table);
    leave_out({"axis", "normal", "point", "radius"}, "surface");
  }

 private:
  void read_place(const char* key) const {
    if (table.has("path"))
      return table.refuse_unless(false, {key}, "left out beside path, which says where it is");
    tool.at = table.required(key, Vector{"a point of three finite numbers (mm)"});
  }
  double radius() const { return table.required("radius", Number{"a number above 0 (mm)", is_positive}); }
  void leave_out(std::initializer_list<const char*> keys, const std::string& shape) const {
    table.refuse_unless(false, keys, "left out: it belongs to another shape than \"" + shape + "\"");
  }
};

/// Reads [[time, x, y, z], ...].
std::vector<std::array<double, 4>> read_path(const Entry& entry) {
  const std::string allowed = "a list of [time (s), x, y, z (mm)], with times from 0 that ascend";
  std::vector<std::array<double, 4>> path;
  for (const Entry& element : entry.elements(allowed)) {
    const std::vector<double> n = Numbers{"[time (s), x, y, z (mm)], four finite numbers", 4}(element);
    if (!(n[0] >= 0 && (path.empty() || n[0] > path.back()[0]))) element.refuse("part of " + allowed);
    path.push_back({n[0], n[1], n[2], n[3]});
  }
  return path;
}

/// Reads how a tool moves.
void read_way(Table& keys, const Case& definition, Tool& tool) {
  keys.refuse_unless(definition.dynamics.has_value(), {"path"},
                     "left out without [dynamics]: a static case has no time");
  tool.path = keys.optional("path", read_path).value_or(tool.path);
  if (!tool.path.empty()) {
    keys.refuse_unless(false, {"displacement", "history"}, "left out beside path, which says how it moves");
    tool.at = {tool.path.front()[1], tool.path.front()[2], tool.path.front()[3]};
    return;
  }
  tool.displacement =
      keys.optional("displacement", Vector{"three finite numbers (mm)"}).value_or(tool.displacement);
  tool.history = read_history(keys, definition.dynamics.has_value());
}

Tool read_tool(Table& keys, const Case& definition) {
  Tool tool;
  tool.where = keys.where();
  tool.name = keys.required("name", read_text);
  for (const Tool& other : definition.tools)
    if (other.name == tool.name) keys.entry("name").refuse("a new name: another tool has this one");
  tool.shape = keys.required("shape", read_kind<tools::Kind>);
  std::visit(ToolKeys{keys, tool, definition.file}, tool.shape);
  read_way(keys, definition, tool);
  keys.refuse_unless(!definition.dynamics, {"steps"},
                     "left out beside [dynamics]: its step is the tool's too");
  tool.steps = keys.optional("steps", WholeNumber{"a whole number from 1 to 1000", 1, 1000}).value_or(1);
  const auto is_coefficient = [](double value) { return value >= 0 && value <= Tool::most_friction; };
  tool.friction =
      keys.optional("friction",
                    Number{fmt::format("a number from 0 to {:g}: Coulomb's coefficient", Tool::most_friction),
                           is_coefficient})
          .value_or(0);
  if (keys.has("region")) {
    tool.region = read_region_entry(keys.entry("region"), definition.body);
    if (tool.region->part)
      keys.entry("region").refuse(
          "the name of a region, or a table with plane: what a box has of the surface "
          "changes with the mesh");
  }
  keys.know({"region"});
  return tool;
}

/// A tool that is elsewhere all of a sudden would have passed through the body.
void check_in_time(const Case& definition) {
  for (std::size_t i = 0; i < definition.tools.size(); ++i) {
    const Tool& tool = definition.tools[i];
    if (!tool.path.empty()) continue;
    const bool moves = tool.moves();
    if (moves && !tool.history.is_given())
      refuse(tool.where,
             "history is missing, must say how the tool's displacement follows time beside [dynamics]");
    if (!moves && tool.history.is_given())
      refuse(tool.where, "history must be left out without a displacement: the tool stays");
    if (tool.history.jumps()) refuse(tool.where, "history jumps, must be continuous: a tool passes no body");
    check_sine(tool.history, *definition.dynamics, "tool", i);
  }
  const TimeScheme& scheme = definition.dynamics->scheme;
  if (scheme.scheme == Scheme::generalized_alpha && scheme.rho_infinity != 0)
    refuse(definition.dynamics->where,
           "rho_infinity is {}, must be 0 beside [[tool]]: other schemes of this family meet tools within a "
           "step, "
           "and have no steady force at its end; \"implicit_euler\", \"bdf2\" and \"newmark\" do",
           scheme.rho_infinity);
  if (definition.dynamics->start != MotionStart::rest)
    refuse_tools(definition, "dynamics.start = \"equilibrium\"",
                 "a motion with tools starts at rest; let a history bring the body to where it is to begin");
}

} // namespace

std::size_t read_tool_index(const Entry& entry, const std::vector<Tool>& tools) {
  std::vector<std::string> names;
  for (const Tool& one : tools) names.push_back(one.name);
  if (names.empty()) entry.refuse("the name of a [[tool]], and the case has none");
  const std::string name = entry.word(names);
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

void read_tools(Table& root, Case& result) {
  result.tools = root.sections("tool", [&](Table& table) {
    Tool tool = read_tool(table, result);
    result.tools.push_back(tool); // the next one's name must be another
    return tool;
  });
}

void check_tools(const Case& definition) {
  if (definition.tools.empty()) return;
  if (definition.dynamics) check_in_time(definition);
  if (definition.msm.solver != Solver::newton)
    refuse_tools(definition, "another solver than \"newton\"", "it knows no contact");
  if (definition.msm.real_time || definition.fem.real_time)
    refuse_tools(definition, "real_time", "its steps know no contact");
  if (definition.msm.iterations_per_step)
    refuse_tools(definition, "msm.iterations_per_step",
                 "a step that ends before its nodes have settled against a tool has no force of it");
  if (!has_cells(definition.body))
    refuse_tools(definition, "a network, which has no surface", "give the body cells");
}

void refuse_tools(const Case& definition, const std::string& beside, const std::string& reason) {
  if (!definition.tools.empty())
    refuse(definition.tools.front().where, "must be left out beside {}: {}", beside, reason);
}

} // namespace springproof::cases
