#include "compare/sweep/sweep.hpp"

#include "compare/error_bars/convergence.hpp"
#include "compare/measure/measure.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace springproof::compare {

namespace {

using Field = std::vector<Eigen::Vector3d>;

constexpr double factor_with_order = 1.25, factor_without_order = 3; ///< Roache's (1994)
constexpr double resolved_percent = 1e-7; ///< what a solve to a residual of 1e-9 leaves undecided

/// Place of a node of one grid between two of another, along one axis.
struct Place {
  std::size_t lower;
  double weight_of_upper; ///< 0 to 1
};

/// Places in whole numbers, so that nodes which coincide do so exactly.
std::vector<Place> places(int from, int to) {
  std::vector<Place> all;
  for (int i = 0; i <= to; ++i) {
    const int lower = std::min(i * from / to, from - 1);
    all.push_back({static_cast<std::size_t>(lower), static_cast<double>(i * from - lower * to) / to});
  }
  return all;
}

/// A displacement as the measures want it; volumes are those of the cells that it deforms.
cases::Solution as_solution(const cases::Scene& scene, const Field& displacement) {
  cases::Solution solution;
  solution.status = cases::Status::converged;
  solution.displacement = displacement;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    solution.cell_volume.push_back(cases::cell_volume(cases::cell_corners(scene.mesh, c, displacement)));
  return solution;
}

cases::Measure field_measure() {
  return {"displacement field", cases::measures::DisplacementFieldL2{}, {}};
}

/// L2 norm of other - truth over that of truth, percent.
std::optional<double> difference_percent(const cases::Scene& scene, const Field& truth, const Field& other) {
  return measure_error_percent(field_measure(), scene, as_solution(scene, truth), as_solution(scene, other));
}

/// The finest value with three times the last change where no limit is approached.
ReferenceValue judge(const std::string& name, const std::string& unit, const std::vector<double>& values) {
  const auto found =
      find_limit(values, 4, 4); // the order of triquadratic elements, where everything is smooth
  const double finest = values.back();
  const auto percent = [&](double uncertainty) { return 100 * std::abs(uncertainty / finest); };
  if (const auto* limit = std::get_if<Limit>(&found))
    return {name, unit, limit->value, percent(limit->uncertainty), limit->note};
  return {name, unit, finest, percent(factor_without_order * (finest - values[values.size() - 2])),
          std::get<std::string>(found)};
}

/// Extrapolates the displacement on the middle mesh.
ReferenceValue judge_field(const cases::Scene& coarsest, const std::array<Field, 3>& on_coarsest,
                           const Field& middle, Field& finest) {
  const double before = difference_percent(coarsest, on_coarsest[2], on_coarsest[0]).value_or(0);
  const double last = difference_percent(coarsest, on_coarsest[2], on_coarsest[1]).value_or(0);
  // The middle and the coarsest mesh's distances to the finest are in the ratio (r^2p - 1)/(r^p - 1) = r^p
  // + 1.
  const double power = before / last - 1;
  if (last <= resolved_percent)
    return {"", "mm", 0, factor_without_order * last,
            "the two finest meshes agree: there is nothing to extrapolate"};
  if (!(power > 1))
    return {"", "mm", 0, factor_without_order * last, "the displacements do not draw nearer to each other"};
  for (std::size_t n = 0; n < finest.size(); ++n) finest[n] += (finest[n] - middle[n]) / (power - 1);
  return {"", "mm", 0, factor_with_order * last / (power - 1), ""};
}

/// @param cells  0: of the reference's own mesh
Field at_nodes_of(const Reference& reference, const std::array<int, 3>& cells, const Field& displacement) {
  if (cells == std::array<int, 3>{}) return displacement;
  return interpolate(displacement, cells, reference.scene.mesh.grid->cells);
}

} // namespace

cases::Scene scene_on(const cases::Case& definition, const std::array<int, 3>& cells) {
  cases::Case resized = definition;
  std::get<cases::Box>(resized.body).cells = cells;
  return cases::make_scene(resized);
}

Reference make_reference(const cases::Case& definition, const std::array<std::array<int, 3>, 3>& cells,
                         const std::array<std::vector<Eigen::Vector3d>, 3>& displacement) {
  Reference reference;
  reference.scene = scene_on(definition, cells[1]);
  std::array<Field, 3> on_coarsest, on_middle;
  for (std::size_t mesh = 0; mesh < 3; ++mesh) {
    on_coarsest[mesh] = interpolate(displacement[mesh], cells[mesh], cells[0]);
    on_middle[mesh] = interpolate(displacement[mesh], cells[mesh], cells[1]);
  }
  for (const cases::Measure& measure : definition.measures) {
    std::vector<double> values;
    for (const Field& field : on_middle)
      values.push_back(evaluate(measure, reference.scene, as_solution(reference.scene, field)));
    reference.measures.push_back(judge(measure.name, unit_of(measure), values));
  }
  cases::Case without_measures = definition; // whose nodes the coarsest mesh need not have
  without_measures.measures.clear();
  Field truth = on_middle[2];
  reference.field = judge_field(scene_on(without_measures, cells[0]), on_coarsest, on_middle[1], truth);
  reference.solution = as_solution(reference.scene, truth);
  reference.field.name = field_measure().name;
  reference.field.value = evaluate(field_measure(), reference.scene, reference.solution);
  return reference;
}

Reference reference_of(const Comparison& solved) {
  const std::string same_mesh = "the finite elements on the same mesh; their limit is not known";
  const auto percent = [](double part, double whole) { return part == 0 ? 0 : 100 * std::abs(part / whole); };
  const FieldLimit* limit =
      solved.mesh_study && solved.mesh_study->field ? &*solved.mesh_study->field : nullptr;
  Reference reference;
  reference.scene = solved.scene;
  reference.solution =
      as_solution(solved.scene, limit ? limit->value : solved.answers.fem.solution.displacement);
  const double size = evaluate(field_measure(), solved.scene, reference.solution);
  reference.field = {field_measure().name, "mm", size, 0, limit ? limit->note : same_mesh};
  if (limit)
    reference.field.uncertainty_percent =
        percent(field_norm(field_measure().kind, solved.scene.mesh, limit->uncertainty), size);
  for (const MeasuredValue& one : solved.measures)
    if (one.fem_limit)
      reference.measures.push_back({one.name, one.unit, one.fem_limit->value,
                                    percent(one.fem_limit->uncertainty, one.fem_limit->value),
                                    one.fem_limit->note});
    else
      reference.measures.push_back({one.name, one.unit, one.fem.value_or(0), 0, same_mesh});
  return reference;
}

std::optional<double> field_error_percent(const Reference& reference, const std::array<int, 3>& cells,
                                          const std::vector<Eigen::Vector3d>& displacement) {
  return difference_percent(reference.scene, reference.solution.displacement,
                            at_nodes_of(reference, cells, displacement));
}

std::vector<std::optional<double>> measure_errors_percent(const Reference& reference,
                                                          const std::array<int, 3>& cells,
                                                          const std::vector<Eigen::Vector3d>& displacement) {
  const cases::Solution solution = as_solution(reference.scene, at_nodes_of(reference, cells, displacement));
  const auto& measures = reference.scene.definition.measures;
  std::vector<std::optional<double>> errors;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    errors.push_back(is_field_norm(measures[m].kind)
                         ? measure_error_percent(measures[m], reference.scene, reference.solution, solution)
                         : error_percent(reference.measures[m].value,
                                         evaluate(measures[m], reference.scene, solution),
                                         zero_of(measures[m], reference.scene, reference.solution)));
  }
  return errors;
}

Field interpolate(const Field& field, const std::array<int, 3>& from, const std::array<int, 3>& to) {
  const auto n_x = static_cast<std::size_t>(from[0] + 1), n_y = static_cast<std::size_t>(from[1] + 1);
  assert(field.size() == n_x * n_y * static_cast<std::size_t>(from[2] + 1));
  Field result;
  for (const Place& z : places(from[2], to[2]))
    for (const Place& y : places(from[1], to[1]))
      for (const Place& x : places(from[0], to[0])) {
        Eigen::Vector3d value = Eigen::Vector3d::Zero();
        for (std::size_t corner = 0; corner < 8; ++corner) {
          const std::size_t i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
          const double weight = (i ? x.weight_of_upper : 1 - x.weight_of_upper) *
                                (j ? y.weight_of_upper : 1 - y.weight_of_upper) *
                                (k ? z.weight_of_upper : 1 - z.weight_of_upper);
          value += weight * field[(z.lower + k) * n_x * n_y + (y.lower + j) * n_x + x.lower + i];
        }
        result.push_back(value);
      }
  return result;
}

} // namespace springproof::compare
