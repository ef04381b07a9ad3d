#include "cases/case/names.hpp"

#include "cases/case/hard_case.hpp"

#include <algorithm>

namespace springproof::cases {

template<>
const NameTable<LoadKind>& names() {
  static const NameTable<LoadKind> table{{LoadKind::nodal_force, "nodal_force"},
                                         {LoadKind::total_force, "total_force"},
                                         {LoadKind::traction, "traction"},
                                         {LoadKind::torque, "torque"}};
  return table;
}

template<>
const NameTable<Formulation>& names() {
  static const NameTable<Formulation> table{{Formulation::small_strain, "small_strain"},
                                            {Formulation::saint_venant_kirchhoff, "saint_venant_kirchhoff"},
                                            {Formulation::log_strain, "log_strain"},
                                            {Formulation::hyperelastic, "hyperelastic"}};
  return table;
}

template<>
const NameTable<Element>& names() {
  static const NameTable<Element> table{{Element::q1, "q1"},
                                        {Element::q1_bbar, "q1_bbar"},
                                        {Element::q1_p0, "q1_p0"},
                                        {Element::q2, "q2"},
                                        {Element::q2_p1, "q2_p1"}};
  return table;
}

template<>
const NameTable<Design>& names() {
  static const NameTable<Design> table{{Design::linear_method, "linear_method"},
                                       {Design::nonlinear_method, "nonlinear_method"},
                                       {Design::moduli, "moduli"},
                                       {Design::hybrid, "hybrid"},
                                       {Design::multi_load, "multi_load"},
                                       {Design::given, "given"}};
  return table;
}

template<>
const NameTable<LoadPath>& names() {
  static const NameTable<LoadPath> table{{LoadPath::uniaxial, "uniaxial"},
                                         {LoadPath::equibiaxial, "equibiaxial"},
                                         {LoadPath::pure_shear, "pure_shear"},
                                         {LoadPath::simple_shear, "simple_shear"}};
  return table;
}

template<>
const NameTable<Solver>& names() {
  static const NameTable<Solver> table{{Solver::newton, "newton"},
                                       {Solver::force_scaling, "force_scaling"},
                                       {Solver::fire, "fire"},
                                       {Solver::lbfgs, "lbfgs"},
                                       {Solver::snes, "snes"}};
  return table;
}

template<>
const NameTable<MeasureKind>& names() {
  static const NameTable<MeasureKind> table{{MeasureKind::coordinate, "coordinate"},
                                            {MeasureKind::displacement, "displacement"},
                                            {MeasureKind::tilt, "tilt"},
                                            {MeasureKind::twist, "twist"},
                                            {MeasureKind::volume, "volume"},
                                            {MeasureKind::displacement_field_l2, "displacement_field_l2"},
                                            {MeasureKind::displacement_field_max, "displacement_field_max"}};
  return table;
}

template<>
const NameTable<Axis>& names() {
  static const NameTable<Axis> table{{Axis::x, "x"}, {Axis::y, "y"}, {Axis::z, "z"}};
  return table;
}

template<>
const NameTable<Component>& names() {
  static const NameTable<Component> table{
      {Component::x, "x"}, {Component::y, "y"}, {Component::z, "z"}, {Component::norm, "norm"}};
  return table;
}

template<>
const NameTable<ReferenceKind>& names() {
  static const NameTable<ReferenceKind> table{{ReferenceKind::exact, "exact"},
                                              {ReferenceKind::converged, "converged"},
                                              {ReferenceKind::peer, "peer"},
                                              {ReferenceKind::published, "published"},
                                              {ReferenceKind::regression, "regression"}};
  return table;
}

template<>
const NameTable<Quantity>& names() {
  static const NameTable<Quantity> table{
      {Quantity::error_percent, "error_percent"}, {Quantity::msm, "msm"}, {Quantity::fem, "fem"}};
  return table;
}

template<>
const NameTable<Status>& names() {
  static const NameTable<Status> table{
      {Status::converged, "converged"}, {Status::failed, "failed"}, {Status::skipped, "skipped"}};
  return table;
}

template<>
const NameTable<Outcome>& names() {
  static const NameTable<Outcome> table{{Outcome::unknown, "unknown"},
                                        {Outcome::stable_equilibrium, "stable equilibrium"},
                                        {Outcome::unstable_equilibrium, "unstable equilibrium"},
                                        {Outcome::limit_point, "limit point"},
                                        {Outcome::mechanism, "mechanism"},
                                        {Outcome::refused, "refused"}};
  return table;
}

template<>
const NameTable<Side>& names() {
  static const NameTable<Side> table{{Side::msm, "msm"}, {Side::hybrid, "hybrid"}, {Side::fem, "fem"}};
  return table;
}

template<>
const NameTable<Start>& names() {
  static const NameTable<Start> table{
      {Start::rest, "rest"}, {Start::perturbed, "perturbed"}, {Start::inverted, "inverted"}};
  return table;
}

namespace {

/// Least number of insertions, deletions, replacements and exchanges of neighbours that turn a into b
/// (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

} // namespace

std::string alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "\"" : " | \"") + word + "\"";
  return text;
}

std::optional<std::string> nearest_name(const std::string& written, const std::vector<std::string>& known) {
  std::optional<std::string> nearest;
  if (written.size() < 3) return nearest; // a single letter is one edit away from every other
  std::size_t allowed = written.size() / 3;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(written, candidate);
    if (distance > allowed || (nearest && distance == allowed)) continue;
    nearest = candidate;
    allowed = distance;
  }
  return nearest;
}

} // namespace springproof::cases
