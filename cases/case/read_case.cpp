#include "cases/case/read_case.hpp"

#include "cases/case/input_file.hpp"
#include "cases/case/readers.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace springproof::cases {

namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Names label rows of reports and files of results.
std::string read_case_name(const Entry& entry) {
  const std::string name = read_text(entry);
  constexpr std::size_t longest = 200; // a file's name may have 255 bytes, endings included
  const auto is_of_word = [](char c) {
    return c < 0 || c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0;
  };
  const bool is_clean = name.size() <= longest && name.find_first_of("/\\\"") == std::string::npos &&
                        is_of_word(name.front()) && name.back() != ' ' && name.back() != '.' &&
                        std::none_of(name.begin(), name.end(), [](char c) { return c >= 0 && c < ' '; });
  if (!is_clean)
    entry.refuse("a name that begins with a letter, a digit or _, ends with neither a blank nor a point, has "
                 "no /, \\, quotes or line breaks, and 200 bytes at most: it names files of results");
  for (const char* ending : {"_springs", "_modes"}) // NAME_springs.vtu
    if (ends_with(in_small_letters(name), ending))
      entry.refuse(
          fmt::format("a name that does not end with {}: a file of that name is written for the case \"{}\"",
                      ending, name.substr(0, name.size() - std::string(ending).size())));
  return name;
}

Removed read_removed(Table& table, bool is_dynamic) {
  Removed removed;
  removed.where = table.entry("box").where;
  std::tie(removed.lower, removed.upper) = table.required("box", Corners{});
  removed.join = table.optional("join", read_name<Axis>);
  if (removed.join && is_dynamic)
    table.entry("join").refuse("left out in a dynamic case: cuts are joined in statics alone");
  return removed;
}

/// Two nodes that must differ for the direction between them to exist. Different names of one node are found
/// on the mesh.
void check_differ(Table& table, const std::string& key, const Region& here, const Region& other,
                  const std::string& other_key) {
  if (here.name == other.name && here.near == other.near)
    table.entry(key).refuse(
        fmt::format("another node than {}: there is no direction from a node to itself", other_key));
}

/// The keys of a measure's kind.
struct MeasureKeys {
  Table& table;
  const Body& body;
  const std::vector<Tool>& tools;

  /// Reads a text, or { nearest = [...], tolerance = 2 }.
  Region node(const char* key) const {
    const Entry entry = table.entry(key);
    if (!entry.node || !entry.node->is_table()) return read_region_text(entry, body);
    Table row(entry, "the name of a node, or a table with nearest and tolerance");
    Region region = read_nearest(row);
    row.refuse_unknown_keys();
    return region;
  }

  /// Reads node(), a node by nearest and tolerance, or a point of a cell by at.
  Region place() const {
    table.know({"at", "nearest"});
    if (table.has("nearest")) {
      table.refuse_unless(false, {"node", "at"}, "left out beside nearest: they say the same thing twice");
      return read_nearest(table);
    }
    table.refuse_unless(false, {"tolerance"},
                        "left out without nearest, from whose point it is the distance");
    if (!table.has("at")) return node("node");
    table.refuse_unless(false, {"node"}, "left out beside at: they say the same thing twice");
    const Entry at = table.entry("at");
    Region region{"", Vector{"three finite numbers (mm), a point of the body at rest"}(at), at.where};
    region.is_in_cell = true;
    return region;
  }

  void operator()(measures::Coordinate& measure) const {
    measure.node = place();
    measure.axis = table.required("axis", read_name<Axis>);
  }
  void operator()(measures::Displacement& measure) const {
    measure.node = place();
    measure.component = table.required("component", read_name<Component>);
  }
  void operator()(measures::Tilt& measure) const {
    measure.top = node("top");
    measure.bottom = node("bottom");
    measure.toward = table.required("toward", read_name<Axis>);
    measure.up = table.optional("up", read_name<Axis>).value_or(Axis::z);
    check_differ(table, "top", measure.top, measure.bottom, "bottom");
    if (measure.toward == measure.up)
      table.entry("toward").refuse("another axis than up, which is \"{}\"", name_of(measure.up));
  }
  void operator()(measures::Twist& measure) const {
    measure.node = node("node");
    measure.centre = node("centre");
    measure.axis = table.optional("axis", read_name<Axis>).value_or(Axis::z);
    check_differ(table, "node", measure.node, measure.centre, "centre");
  }
  void operator()(measures::Reaction& measure) const {
    measure.region = read_region(table, body);
    measure.component = table.required("component", read_name<Component>);
  }
  void operator()(measures::Curvature& measure) const {
    measure.region = read_region(table, body);
    measure.axis = table.required("axis", read_name<Axis>);
  }
  void operator()(measures::Stress& measure) const { read_of_cells(measure, all_names<TensorComponent>()); }
  /// A strain has no component von_mises: there are several equivalent strains.
  void operator()(measures::Strain& measure) const {
    std::vector<std::string> components = all_names<TensorComponent>();
    components.erase(std::find(components.begin(), components.end(), name_of(TensorComponent::von_mises)));
    read_of_cells(measure, components);
  }
  void operator()(measures::StrainEnergy&) const {}
  void operator()(measures::Volume&) const {}
  void operator()(measures::DisplacementFieldL2&) const {}
  void operator()(measures::DisplacementFieldMax&) const {}
  /// Reads the measures of a tool.
  template<class Kind>
  auto operator()(Kind& measure) const -> decltype(void(measure.tool)) {
    measure.tool = read_tool_index(table.entry("tool"), tools);
    if constexpr (std::is_same_v<Kind, measures::ToolForce> || std::is_same_v<Kind, measures::ToolTorque>)
      measure.component = table.required("component", read_name<Component>);
  }

  void read_of_cells(measures::OfCells& measure, const std::vector<std::string>& components) const {
    measure.component = *value_of<TensorComponent>(table.entry("component").word(components));
    table.know({"statistic", "point", "region", "near", "radius", "nearest", "tolerance"});
    if ((measure.statistic = table.optional("statistic", read_name<Statistic>))) {
      table.refuse_unless(false, {"point"}, "left out beside statistic, which is of several cells");
      if (table.has("region") || table.has("near")) measure.region = read_region(table, body);
      return;
    }
    table.refuse_unless(false, {"region", "near", "radius", "nearest", "tolerance"},
                        "left out without statistic");
    measure.point_where = table.entry("point").where;
    measure.point = table.required("point", Vector{"three finite numbers (mm), a point of the body at rest"});
  }
};

Measure read_measure(Table& table, const Case& definition) {
  Measure measure;
  measure.where = table.where();
  measure.name = table.required("name", read_text);
  measure.kind = table.required("kind", read_kind<measures::Kind>);
  std::visit(MeasureKeys{table, definition.body, definition.tools}, measure.kind);
  if (definition.dynamics && !measures::is_in_time(measure.kind))
    table.entry("kind").refuse("a measure of single nodes' displacements, of volume or of a tool: reactions, "
                               "stresses and curvatures of a motion are not recorded");
  measure.over_time = read_over_time(table, measure.kind, definition.dynamics.has_value());
  return measure;
}

Expectation read_expectation(Table& table, const std::vector<std::string>& measures) {
  Expectation expectation;
  expectation.where = table.where();
  expectation.measure = table.required("measure", read_text);
  table.entry("measure").word(measures);
  int n_quantities = 0;
  for (const std::string& key : all_names<Quantity>()) {
    const auto interval = table.optional(key, Numbers{"an interval [lower, upper] of two finite numbers", 2});
    if (!interval) continue;
    if (++n_quantities > 1)
      table.entry(key).refuse("left out: an expectation bounds one quantity, give each its own");
    if (!((*interval)[0] <= (*interval)[1]))
      table.entry(key).refuse("an interval [lower, upper] with lower <= upper");
    expectation.quantity = *value_of<Quantity>(key);
    const std::vector<Entry> ends = table.entry(key).elements("");
    expectation.ends_where = {ends[0].where, ends[1].where};
    expectation.interval = {(*interval)[0], (*interval)[1]};
  }
  if (n_quantities == 0)
    table.entry("error_percent").refuse("an interval [lower, upper], here or for msm or for fem");
  expectation.reference = table.required("reference", read_name<ReferenceKind>);
  expectation.reason = table.required("reason", read_text);
  return expectation;
}

void read_measures(Table& root, Case& result) {
  const bool moves_surface = result.dynamics && root.has("surface");
  std::vector<std::string> seen;
  result.measures = root.sections("measure", [&](Table& table) {
    Measure measure = read_measure(table, result);
    const auto same = std::find(seen.begin(), seen.end(), measure.name);
    if (same != seen.end())
      table.entry("name").refuse("a new name: measure[{}] has this one", same - seen.begin());
    if (moves_surface && measure.name == surface_measure)
      table.entry("name").refuse("another name: in motion the [surface] is a measure of this one");
    seen.push_back(measure.name);
    result.has_fields = result.has_fields || is_of_fields(measure.kind);
    if (result.fem.real_time && is_of_fields(measure.kind))
      table.entry("kind").refuse(
          "one of the displacement beside fem.real_time, whose steps leave forces that "
          "are in no balance");
    return measure;
  });
  if (moves_surface) seen.emplace_back(surface_measure);
  result.expectations = root.sections("expect", [&](Table& table) { return read_expectation(table, seen); });
}

BodySurface read_contour(Table& table, const Labels& picture) {
  const PictureContour contour{
      table.required("intensity", Number{"a finite number, an intensity"}),
      table.optional("smoothing", WholeNumber{"a whole number of passes, 0 to 1000", 0, 1000}).value_or(0),
      static_cast<std::size_t>(
          table.optional("triangles", WholeNumber{"a whole number, 100 to 5000000", 100, 5'000'000})
              .value_or(0))};
  table.refuse_unless(false, {"file", "scale"}, "left out: the surface is the contour of the body's picture");
  return {{picture.file.path, table.entry("intensity").where}, contour, 1};
}

BodySurface read_surface_file(Table& table, const std::string& case_path) {
  table.refuse_unless(false, {"intensity", "smoothing", "triangles"},
                      "left out: with shape = \"labels\" alone there is a picture to make a contour of");
  return {read_file_name(table.entry("file"), {".stl", ".vtp"}, "a surface, .stl or .vtp", case_path),
          {},
          read_scale(table)};
}

void read_surface(Table& root, Case& result) {
  result.surface = root.section_if_there("surface", [&](Table& table) {
    const Labels* const picture = std::get_if<Labels>(&result.body);
    return picture != nullptr && table.has("intensity") ? read_contour(table, *picture)
                                                        : read_surface_file(table, result.file);
  });
  std::vector<std::string> seen;
  result.landmarks = root.sections("landmark", [&](Table& table) {
    Landmark landmark{
        table.required("name", read_text),
        table.required("point", Vector{"three finite numbers (mm), a point of the body's surface"})};
    if (contains(seen, landmark.name))
      table.entry("name").refuse("a new name: another landmark has this one");
    seen.push_back(landmark.name);
    return landmark;
  });
}

/// Checks that the settings of the finite elements and of their accuracy fit together.
void check_accuracy(Table& root, const Case& definition) {
  const auto asks_of_fem = [](const Expectation& e) { return e.quantity != Quantity::msm; };
  const auto& expectations = definition.expectations;
  if (definition.fem.has_auto_formulation &&
      std::none_of(expectations.begin(), expectations.end(), asks_of_fem))
    root.entry("expect").refuse("one or more tables [[expect]] with error_percent or fem: formulation = "
                                "\"auto\" in [fem] is as accurate as they ask for");
  if (definition.fem.has_auto_accuracy) return;
  for (const Expectation& expected : expectations)
    if (asks_of_fem(expected) && expected.reference == ReferenceKind::converged)
      throw InputError(expected.where, "reference must not be \"converged\" beside fem.accuracy = \"none\", "
                                       "with which no limit is looked for");
}

Case read_definition(Table& root, const std::string& path, Purpose purpose = Purpose::motion) {
  Case result;
  result.file = path;
  root.required("schema", WholeNumber{"1, the version of the format that this program reads", 1, 1});
  result.name = root.required("name", read_case_name);
  result.description = root.optional("description", read_text).value_or("");
  result.body = root.section("body", [&](Table& table) {
    const auto read = [&](Table& piece) { return read_removed(piece, root.has("dynamics")); };
    result.removed = table.sections("removed", read);
    return read_body(table, path);
  });
  result.fem_body = read_fem_body(root, result);
  result.dynamics = read_dynamics(root);
  read_materials(root, result);
  read_boundary(root, result);
  read_tools(root, result);
  if (purpose == Purpose::motion) check_boundary(root, result);
  read_models(root, result);
  check_dynamics(root, result);
  check_tools(result);
  read_measures(root, result);
  check_network(root, result);
  read_surface(root, result);
  check_accuracy(root, result);
  check_turns(result);
  return result;
}

Case read_document(const toml::table& document, const std::string& path, Purpose purpose = Purpose::motion) {
  Table root({&document, Where{path, 1, 1, ""}}, "a table");
  if (root.has("stress"))
    root.entry("stress").refuse("left out: this is a hard case, for the command stress alone");
  Case result = read_definition(root, path, purpose);
  root.refuse_unknown_keys();
  return result;
}

Stiffer read_stiffer(Table& table) {
  return {table.required("axis", read_name<Axis>), table.required("beyond", Number{"a finite number (mm)"}),
          table.required("factor", Number{"a number above 0", is_positive})};
}

Outcome read_outcome(const Entry& entry) {
  std::vector<std::string> allowed = all_names<Outcome>();
  allowed.erase(std::remove(allowed.begin(), allowed.end(), name_of(Outcome::unknown)), allowed.end());
  return *value_of<Outcome>(entry.word(allowed));
}

/// Models of a hard case that outcomes can be expected of: the table, and what is solved for it.
const ExpectedOutcome models[] = {{"msm", Side::msm, {}, {}, {}, {}},
                                  {"hybrid", Side::msm, Design::hybrid, {}, {}, {}},
                                  {"fem", Side::fem, {}, {}, {}, {}}};

ExpectedOutcome read_expected(Table& table, ExpectedOutcome expected) {
  expected.outcome = table.required("outcome", read_outcome);
  const std::string allowed = "an interval [lower, upper] with 0 <= lower <= upper <= 1";
  const auto is_part = [](double load) { return 0 <= load && load <= 1; };
  expected.load_reached = table.optional("load_reached", Interval<std::less_equal<>>{allowed, is_part});
  expected.inverted_cells =
      table.optional("inverted_cells", WholeNumber{"a whole number from 0", 0, 2147483647});
  return expected;
}

void read_start(Table& table, Stress& result) {
  result.start = table.optional("start", read_name<Start>).value_or(Start::rest);
  if (result.start == Start::perturbed) {
    result.amplitude = table.required("amplitude", Number{"a number above 0 (mm)", is_positive});
    result.seed = table.required("seed", WholeNumber{"a whole number from 0", 0, 2147483647});
    return;
  }
  table.refuse_unless(false, {"amplitude", "seed"}, "left out: it belongs to start = \"perturbed\"");
}

/// Reads [stress] of a hard case.
/// @param msm  the case's springs; stiffnesses, if there are any, replace their design
Stress read_stress(Table& table, Msm& msm) {
  Stress result;
  result.is_heavy = table.optional("heavy", read_truth).value_or(false);
  read_start(table, result);
  const auto stiffness =
      table.optional("stiffness", Array<3>{"three finite numbers k_e, k_f, k_d (N/m), of any sign"});
  if (stiffness) {
    msm.design = Design::given;
    msm.stiffness = stiffness;
    msm.axis_stiffness.reset();
    msm.volume_stiffness = 0;
  }
  result.stiffer = table.section_if_there("stiffer", read_stiffer);
  result.least_load_steps =
      table.optional("least_load_steps", WholeNumber{"a whole number from 1 to 1000", 1, 1000}).value_or(1);
  result.max_seconds = table.required("max_seconds", Number{"a number above 0", is_positive});
  result.max_iterations = table.required("max_iterations", WholeNumber{"a whole number from 1", 1, 1000000});
  for (const ExpectedOutcome& model : models)
    if (const auto expected = table.section_if_there(
            model.model, [&](Table& section) { return read_expected(section, model); }))
      result.expected.push_back(*expected);
  if (result.expected.empty())
    table.entry("msm").refuse("a table [stress.msm], [stress.hybrid] or [stress.fem] with an outcome");
  if (stiffness && table.has("hybrid"))
    table.entry("stiffness").refuse("left out beside [stress.hybrid], which designs its own");
  return result;
}

} // namespace

Case read_case(const std::string& path, const std::vector<std::string>& overrides, Purpose purpose) {
  return read_document(parse_file(path, overrides), path, purpose);
}

Case read_case_text(const std::string& text, const std::string& path) {
  return read_document(parse_document(text, path), path);
}

Case read_hard_case(const std::string& path) {
  const toml::table document = parse_file(path, {});
  Table root({&document, Where{path, 1, 1, ""}}, "a table");
  if (root.has("dynamics")) root.entry("dynamics").refuse("left out beside [stress]: hard cases are static");
  Case result = read_definition(root, path);
  for (const auto& [has_steps, where] : {std::pair{result.msm.real_time.has_value(), result.msm.where},
                                         std::pair{result.fem.real_time.has_value(), result.fem.where}})
    if (has_steps) refuse(where, "real_time must be left out beside [stress]");
  result.stress = root.section("stress", [&](Table& table) { return read_stress(table, result.msm); });
  root.refuse_unknown_keys();
  return result;
}

} // namespace springproof::cases
