#include "cases/case/readers.hpp"

namespace springproof::cases {

namespace {

/// The keys of a tool's shape.
struct ToolKeys {
  Table& table;
  Tool& tool;

  void operator()(tools::Sphere& sphere) const {
    read_place("centre");
    sphere.radius = radius();
    leave_out({"axis", "normal", "point"}, "sphere");
  }
  void operator()(tools::Cylinder& cylinder) const {
    read_place("centre");
    cylinder.radius = radius();
    cylinder.axis = table.required("axis", read_direction);
    leave_out({"normal", "point"}, "cylinder");
  }
  void operator()(tools::Punch& punch) const {
    read_place("centre");
    punch.radius = radius();
    punch.axis = table.required("axis", read_direction);
    leave_out({"normal", "point"}, "punch");
  }
  void operator()(tools::Plane& plane) const {
    read_place("point");
    plane.normal = table.required("normal", read_direction);
    leave_out({"axis", "centre", "radius"}, "plane");
  }

 private:
  void read_place(const char* key) const {
    tool.at = table.required(key, Vector{"a point of three finite numbers (mm)"});
  }
  double radius() const { return table.required("radius", Number{"a number above 0 (mm)", is_positive}); }
  void leave_out(std::initializer_list<const char*> keys, const std::string& shape) const {
    table.refuse_unless(false, keys, "left out: it belongs to another shape than \"" + shape + "\"");
  }
};

Tool read_tool(Table& keys, const Case& definition) {
  Tool tool;
  tool.where = keys.where();
  tool.name = keys.required("name", read_text);
  for (const Tool& other : definition.tools)
    if (other.name == tool.name) keys.entry("name").refuse("a new name: another tool has this one");
  tool.shape = keys.required("shape", read_kind<tools::Kind>);
  std::visit(ToolKeys{keys, tool}, tool.shape);
  tool.displacement =
      keys.optional("displacement", Vector{"three finite numbers (mm)"}).value_or(tool.displacement);
  tool.steps = keys.optional("steps", WholeNumber{"a whole number from 1 to 1000", 1, 1000}).value_or(1);
  if (keys.has("region")) tool.region = read_region_entry(keys.entry("region"), definition.body);
  keys.know({"region"});
  return tool;
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
  if (definition.dynamics)
    refuse_tools(definition, "[dynamics]", "contact with tools is solved in statics alone");
  if (definition.msm.solver != Solver::newton)
    refuse_tools(definition, "another solver than \"newton\"", "it knows no contact");
  if (definition.msm.real_time || definition.fem.real_time)
    refuse_tools(definition, "real_time", "its steps know no contact");
  if (!has_cells(definition.body))
    refuse_tools(definition, "a network, which has no surface", "give the body cells");
}

void refuse_tools(const Case& definition, const std::string& beside, const std::string& reason) {
  if (!definition.tools.empty())
    refuse(definition.tools.front().where, "must be left out beside {}: {}", beside, reason);
}

} // namespace springproof::cases
