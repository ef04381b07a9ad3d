#include "cases/case/read_measures.hpp"

#include "cases/case/read_boundary.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::cases {

namespace {

/// Two nodes that must differ for the direction between them to exist. Different names of one node are found
/// on the mesh.
void check_differ(Table& table, const std::string& key, const Region& here, const Region& other,
                  const std::string& other_key) {
  if (here.name == other.name && here.near == other.near)
    table.entry(key).refuse(
        fmt::format("another node than {}: there is no direction from a node to itself", other_key));
}

} // namespace

Measure read_measure(Table& table, const Body& body) {
  const auto node = [&](const Entry& entry) { return read_region_text(entry, body); };
  Measure measure;
  measure.where = table.where();
  measure.name = table.required("name", read_text);
  measure.kind = table.required("kind", read_name<MeasureKind>);
  switch (measure.kind) {
  case MeasureKind::coordinate:
    measure.node = table.required("node", node);
    measure.axis = table.required("axis", read_name<Axis>);
    break;
  case MeasureKind::displacement:
    measure.node = table.required("node", node);
    measure.component = table.required("component", read_name<Component>);
    break;
  case MeasureKind::tilt:
    measure.top = table.required("top", node);
    measure.bottom = table.required("bottom", node);
    measure.toward = table.required("toward", read_name<Axis>);
    measure.axis = table.optional("up", read_name<Axis>).value_or(Axis::z);
    check_differ(table, "top", measure.top, measure.bottom, "bottom");
    if (measure.toward == measure.axis)
      table.entry("toward").refuse(
          fmt::format("another axis than up, which is \"{}\"", name_of(measure.axis)));
    break;
  case MeasureKind::twist:
    measure.node = table.required("node", node);
    measure.centre = table.required("centre", node);
    measure.axis = table.optional("axis", read_name<Axis>).value_or(Axis::z);
    check_differ(table, "node", measure.node, measure.centre, "centre");
    break;
  case MeasureKind::volume:
  case MeasureKind::displacement_field_l2:
  case MeasureKind::displacement_field_max:
    break;
  }
  return measure;
}

Expectation read_expectation(Table& table, const std::vector<Measure>& measures) {
  Expectation expectation;
  expectation.where = table.where();
  const Entry measure = table.entry("measure");
  expectation.measure = read_text(measure);
  std::vector<std::string> known;
  for (const Measure& m : measures) known.push_back(m.name);
  if (std::find(known.begin(), known.end(), expectation.measure) == known.end()) measure.refuse_word(known);

  int n_quantities = 0;
  for (const auto& [quantity, key] : names<Quantity>()) {
    const auto interval = table.optional(key, Numbers{"an interval [lower, upper] of two finite numbers", 2});
    if (!interval) continue;
    if (++n_quantities > 1)
      table.entry(key).refuse("left out: an expectation bounds one quantity, give each its own");
    if (!((*interval)[0] <= (*interval)[1]))
      table.entry(key).refuse("an interval [lower, upper] with lower <= upper");
    expectation.quantity = quantity;
    expectation.interval_where = table.entry(key).where;
    expectation.interval = {(*interval)[0], (*interval)[1]};
  }
  if (n_quantities == 0)
    table.entry("error_percent").refuse("an interval [lower, upper], here or for msm or for fem");
  expectation.reference = table.required("reference", read_name<ReferenceKind>);
  expectation.reason = table.required("reason", read_text);
  return expectation;
}

} // namespace springproof::cases
