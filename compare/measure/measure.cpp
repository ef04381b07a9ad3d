#include "compare/measure/measure.hpp"

#include "cases/mesh/cell_point.hpp"
#include "cases/mesh/sharing.hpp"
#include "mechanics/larger.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace springproof::compare {

namespace measures = cases::measures;
using Eigen::Vector3d;

namespace {

using Points = std::vector<Vector3d>;

constexpr double relative_zero = 1e-8; ///< part of a size that is 0; a solve leaves 1e-9 of its forces

double component_of(const Vector3d& vector, cases::Component component) {
  return component == cases::Component::norm ? vector.norm() : vector[static_cast<int>(component)];
}

// The value of a measure of single nodes, of which `x` are the places at rest and `u` the displacements, mm.

double of_nodes(const measures::Coordinate& measure, const Points& x, const Points& u) {
  return Vector3d(x[0] + u[0])[static_cast<int>(measure.axis)];
}
double of_nodes(const measures::Displacement& measure, const Points&, const Points& u) {
  return component_of(u[0], measure.component);
}
double of_nodes(const measures::Tilt& measure, const Points& x, const Points& u) {
  const Vector3d edge = Vector3d(x[0] + u[0]) - Vector3d(x[1] + u[1]); // from bottom to top
  return degrees_per_radian *
         std::atan2(edge[static_cast<int>(measure.toward)], edge[static_cast<int>(measure.up)]);
}

double of_nodes(const measures::Twist& measure, const Points& x, const Points& u) {
  const Vector3d axis = Vector3d::Unit(static_cast<int>(measure.axis));
  const auto across = [&](const Vector3d& v) { return Vector3d(v - axis.dot(v) * axis); };
  const Vector3d before = across(x[0] - x[1]); // from the centre to the node
  const Vector3d after = across(Vector3d(x[0] + u[0]) - Vector3d(x[1] + u[1]));
  return degrees_per_radian * std::atan2(axis.dot(before.cross(after)), before.dot(after));
}

// What an angle is of; others count no turns.

TurnedSegment segment_of(const measures::Tilt& measure, const Points& x, const std::vector<int>& nodes) {
  return {x[0] - x[1], static_cast<int>(measure.up), static_cast<int>(measure.toward), {nodes[0], nodes[1]}};
}

TurnedSegment segment_of(const measures::Twist& measure, const Points& x, const std::vector<int>& nodes) {
  const int axis = static_cast<int>(measure.axis);
  return {x[0] - x[1], (axis + 1) % 3, (axis + 2) % 3, {nodes[0], nodes[1]}};
}

template<class Kind>
std::optional<TurnedSegment> segment_of(const Kind&, const Points&, const std::vector<int>&) {
  return std::nullopt;
}

/// A measure of a few nodes, on any displacement of them.
class NodeMeasure {
 public:
  NodeMeasure(const cases::Measure& measure, const cases::Scene& scene) : measure_(measure), scene_(scene) {
    cases::for_each_region(measure, [&](const cases::Region& region, bool) {
      places_.push_back(cases::weights_at(scene.mesh, region));
      nodes_.push_back(places_.back().front().node);
      rest_.push_back(at_place(places_.back(),
                               [&](int node) -> Vector3d { return scene.mesh.nodes[cases::index(node)]; }));
    });
    segment_ = std::visit(
        [&](const auto& kind) -> std::optional<TurnedSegment> { return segment_of(kind, rest_, nodes_); },
        measure.kind);
  }

  bool is_angle() const { return segment_.has_value(); }

  /// @param displacement  returns a node's displacement by its number, mm
  template<class Displacement>
  double at(const Displacement& displacement) const {
    Points moved;
    for (const auto& place : places_) moved.push_back(at_place(place, displacement));
    const auto value = [&](const auto& kind) {
      if constexpr (std::decay_t<decltype(kind)>::from == measures::From::nodes)
        return of_nodes(kind, rest_, moved);
      else
        return std::nan(""); // not reached: no NodeMeasure is made of it
    };
    return std::visit(value, measure_.kind);
  }

  /// The value of an angle with whole turns.
  /// @param displacement  mm, one per node that is here   @param time  s; none: of statics
  double with_turns(double value, const Points& displacement, const cases::Sharing* sharing,
                    std::optional<double> time) const {
    if (!segment_) return value;
    const auto factor = [&](const cases::Moved& moved) { return time ? moved.history.at(*time) : 1; };
    TurnedSegment segment = *segment_;
    segment.along[3 - segment.from - segment.towards] = 0;
    // A tilt counts from upwards, not from where the segment is at rest.
    const double at_rest = at([](int) { return Vector3d(0, 0, 0); });
    return at_rest + count_turns(value - at_rest, segment, scene_, displacement, sharing, factor);
  }

 private:
  const cases::Measure& measure_;
  const cases::Scene& scene_;
  /// @param value  returns a node's vector by its number
  template<class Value>
  static Vector3d at_place(const std::vector<cases::NodeWeight>& place, const Value& value) {
    Vector3d sum = Vector3d::Zero();
    for (const auto& [node, weight] : place) sum += weight * value(node);
    return sum;
  }

  std::vector<std::vector<cases::NodeWeight>> places_; ///< in the order in which the measure names them
  std::vector<int> nodes_;                             ///< the first of each; of an angle's, the only one
  Points rest_;                                        ///< mm
  std::optional<TurnedSegment> segment_;
};

/// Sums of every rank's numbers; where nobody shares the solution, they are all.
template<class Numbers>
Numbers sum_of_ranks(Numbers here, const cases::Solution& solution) {
  if (solution.sharing)
    for (double& number : here) number = solution.sharing->sum(number);
  return here;
}

/// The mean over the cells that hold the measure's point.
double at_point(const measures::OfCells& measure, const cases::Scene& scene, const cases::Solution& solution,
                const std::vector<cases::SymmetricTensor>& of_cells) {
  const cases::Range here = cases::share_here(scene.mesh, solution.sharing.get()).cells;
  std::array<double, 7> sums{}; // the tensors' components, and their number
  for (const std::size_t cell : cases::cells_at(scene.mesh, measure.point, here)) {
    for (std::size_t i = 0; i < 6; ++i) sums[i] += of_cells[cell - here.begin][i];
    ++sums[6];
  }
  sums = sum_of_ranks(sums, solution);
  cases::SymmetricTensor mean;
  for (std::size_t i = 0; i < 6; ++i) mean[i] = sums[i] / sums[6];
  return compare::component_of(mean, measure.component); // not the one above, of a vector
}

double reaction(const measures::Reaction& measure, const cases::Scene& scene,
                const cases::Solution& solution) {
  const cases::Share here = cases::share_here(scene.mesh, solution.sharing.get());
  Vector3d sum = Vector3d::Zero();
  for (const int node : cases::select(scene.mesh, measure.region).nodes)
    if (here.own_nodes.has(cases::index(node)))
      sum += solution.fields->reaction[cases::index(node) - here.nodes.begin];
  return component_of(sum_of_ranks(sum, solution), measure.component);
}

/// Lengths of all nodes' reactions, added up.
double sum_of_reactions(const cases::Scene& scene, const cases::Solution& solution) {
  const cases::Share here = cases::share_here(scene.mesh, solution.sharing.get());
  double sum = 0;
  for (std::size_t n = here.own_nodes.begin; n < here.own_nodes.end; ++n)
    sum += solution.fields->reaction[n - here.nodes.begin].norm();
  return solution.sharing ? solution.sharing->sum(sum) : sum;
}

double largest_norm(const std::vector<cases::SymmetricTensor>& tensors, const cases::Solution& solution) {
  double largest = 0;
  for (const cases::SymmetricTensor& tensor : tensors) largest = std::max(largest, tensor_norm(tensor));
  return solution.sharing ? solution.sharing->largest(largest) : largest;
}

double volume(const cases::Solution& solution) {
  const double here = std::accumulate(solution.cell_volume.begin(), solution.cell_volume.end(), 0.0);
  return solution.sharing ? solution.sharing->sum(here) : here;
}

/// Largest size at which a measure's value at a single time counts as zero, whatever number of its course the
/// case asks for.
struct ZeroOfValues {
  const cases::Scene& scene;
  const cases::Solution& solution;

  double operator()(const measures::Coordinate&) const { return relative_zero * size(); }
  double operator()(const measures::Displacement&) const { return length(); }
  double operator()(const measures::DisplacementFieldL2&) const { return length(); }
  double operator()(const measures::DisplacementFieldMax&) const { return length(); }
  double operator()(const measures::Tilt&) const { return degrees_per_radian * length() / size(); }
  double operator()(const measures::Twist&) const { return degrees_per_radian * length() / size(); }
  double operator()(const measures::Reaction&) const {
    return relative_zero * sum_of_reactions(scene, solution);
  }
  double operator()(const measures::Stress&) const {
    return relative_zero * largest_norm(solution.fields->stress, solution);
  }
  double operator()(const measures::Strain&) const {
    return relative_zero * largest_norm(solution.fields->strain, solution);
  }
  double operator()(const measures::Curvature&) const { return length() / (size() * size()); }
  double operator()(const measures::ToolForce& kind) const { return relative_zero * force_of(kind.tool); }
  double operator()(const measures::ToolTorque& kind) const {
    return relative_zero * size() * force_of(kind.tool);
  }
  double operator()(const measures::ContactArea&) const { return relative_zero * size() * size(); }
  double operator()(const measures::Penetration&) const { return 1e-4 / relative_zero * length(); } // settled
  double operator()(const measures::Volume&) const { return 0; }       // none is zero
  double operator()(const measures::StrainEnergy&) const { return 0; } // nor that of what is deformed

  /// Size of a tool's force, in a motion its largest.
  double force_of(std::size_t tool) const {
    double largest = solution.tools[tool].force.norm();
    if (solution.trajectory)
      for (std::size_t n = tool; n < solution.trajectory->tools.size(); n += solution.tools.size())
        largest = std::max(largest, solution.trajectory->tools[n].force.norm());
    return largest;
  }
  double length() const { return zero_of_displacements(scene, solution); }
  double size() const { return cases::bounding_box(scene.mesh.nodes).sizes().norm(); }
};

double zero_of_values(const cases::Measure& measure, const cases::Scene& scene,
                      const cases::Solution& solution) {
  return std::visit(ZeroOfValues{scene, solution}, measure.kind);
}

/// The value of each kind of measure.
struct Evaluation {
  const cases::Measure& measure;
  const cases::Scene& scene;
  const cases::Solution& solution;

  double operator()(const measures::Coordinate&) const { return at_nodes(); }
  double operator()(const measures::Displacement&) const { return at_nodes(); }
  double operator()(const measures::Tilt&) const { return at_nodes(); }
  double operator()(const measures::Twist&) const { return at_nodes(); }
  double operator()(const measures::Volume&) const { return volume(solution); }
  double operator()(const measures::DisplacementFieldL2&) const {
    return solution.norms ? solution.norms->root_mean_square : norm();
  }
  double operator()(const measures::DisplacementFieldMax&) const {
    return solution.norms ? solution.norms->largest : norm();
  }
  double operator()(const measures::Reaction& kind) const { return reaction(kind, scene, solution); }
  double operator()(const measures::StrainEnergy&) const { return solution.fields->total_energy; }
  double operator()(const measures::Stress& kind) const { return of_cells(kind, solution.fields->stress); }
  double operator()(const measures::Strain& kind) const { return of_cells(kind, solution.fields->strain); }
  double operator()(const measures::Curvature& kind) const {
    return largest_curvature(kind, scene, solution);
  }

  double operator()(const measures::ToolForce& kind) const {
    return component_of(solution.tools[kind.tool].force, kind.component);
  }
  double operator()(const measures::ToolTorque& kind) const {
    return component_of(solution.tools[kind.tool].torque, kind.component);
  }
  double operator()(const measures::ContactArea& kind) const { return solution.tools[kind.tool].area; }
  double operator()(const measures::Penetration& kind) const { return solution.tools[kind.tool].penetration; }

  double at_nodes() const {
    const NodeMeasure of_nodes(measure, scene);
    const double value = of_nodes.at([&](int node) -> Vector3d {
      return solution.sharing ? solution.sharing->at(cases::index(node), solution.displacement)
                              : solution.displacement[cases::index(node)];
    });
    const auto& dynamics = scene.definition.dynamics;
    return of_nodes.with_turns(value, solution.displacement, solution.sharing.get(),
                               dynamics ? std::optional(dynamics->end) : std::nullopt);
  }
  double norm() const {
    return field_norm(measure.kind, scene.mesh, solution.displacement, solution.sharing.get());
  }
  double of_cells(const measures::OfCells& kind, const std::vector<cases::SymmetricTensor>& tensors) const {
    return kind.statistic ? of_region(kind, scene, solution, tensors)
                          : at_point(kind, scene, solution, tensors);
  }
};

} // namespace

bool can_evaluate(const cases::Measure& measure, const cases::Solution& solution) {
  if (cases::is_of_tools(measure.kind)) return !solution.tools.empty();
  if (!cases::is_of_fields(measure.kind)) return true;
  return solution.fields && (solution.fields->has_stress || !cases::is<measures::Stress>(measure));
}

double evaluate(const cases::Measure& measure, const cases::Scene& scene, const cases::Solution& solution) {
  if (!can_evaluate(measure, solution))
    throw std::logic_error(measure.name + ": a solution without fields has no value of it");
  return std::visit(Evaluation{measure, scene, solution}, measure.kind);
}

TimeSeries series_of(const cases::Measure& measure, const cases::Scene& scene,
                     const cases::Solution& solution) {
  const cases::Trajectory& seen = *solution.trajectory;
  const double zero = zero_of_values(measure, scene, solution);
  if (cases::is<measures::Volume>(measure)) return {seen.time, seen.volume, zero};
  if (cases::is_field_norm(measure.kind))
    return {{seen.time.back()}, {evaluate(measure, scene, solution)}, zero};
  TimeSeries series{seen.time, {}, zero};
  if (cases::is_of_tools(measure.kind)) {
    cases::Solution at_step; // all that such a measure reads
    const auto n_tools = static_cast<std::ptrdiff_t>(solution.tools.size());
    for (auto first = seen.tools.begin(); first != seen.tools.end(); first += n_tools) {
      at_step.tools.assign(first, first + n_tools);
      series.value.push_back(evaluate(measure, scene, at_step));
    }
    return series;
  }
  const NodeMeasure of_nodes(measure, scene);
  for (std::size_t step = 0; step < seen.time.size(); ++step)
    series.value.push_back(of_nodes.at([&](int node) -> Vector3d {
      const auto place = std::lower_bound(seen.nodes.begin(), seen.nodes.end(), node) - seen.nodes.begin();
      return seen.displacement[step * seen.nodes.size() + cases::index(place)];
    }));
  if (!of_nodes.is_angle()) return series;
  if (!seen.bodies.empty() && seen.bodies.front().step == 0)
    series.value.front() = of_nodes.with_turns(series.value.front(), seen.bodies.front().displacement,
                                               nullptr, seen.time.front());
  count_turns_in_time(series.value);
  return series;
}

std::optional<double> value_of(const cases::Measure& measure, const cases::Scene& scene,
                               const cases::Solution& solution) {
  if (!measure.over_time || !solution.trajectory) return evaluate(measure, scene, solution);
  return value_over_time(*measure.over_time, series_of(measure, scene, solution));
}

std::variant<double, std::string> finite_value(const cases::Measure& measure, const cases::Scene& scene,
                                               const cases::Solution& solution) {
  if (!can_evaluate(measure, solution)) return "the solution is of displacements alone, without its fields";
  std::variant<double, std::string> found;
  if (measure.over_time && solution.trajectory)
    found = number_over_time(*measure.over_time, series_of(measure, scene, solution));
  else
    found = evaluate(measure, scene, solution);
  const double* value = std::get_if<double>(&found);
  return !value || std::isfinite(*value) ? found : "it is not a finite number";
}

bool is_trajectory_norm(const cases::Measure& measure) {
  return measure.over_time == cases::OverTime::trajectory_l2;
}

std::optional<double> field_error_percent(const measures::Kind& kind, const cases::Mesh& mesh,
                                          const std::vector<Vector3d>& reference,
                                          const std::vector<Vector3d>& other, double zero,
                                          const cases::Sharing* sharing) {
  std::vector<Vector3d> difference;
  for (std::size_t n = 0; n < reference.size(); ++n) difference.push_back(other[n] - reference[n]);
  const double size = field_norm(kind, mesh, reference, sharing),
               distance = field_norm(kind, mesh, difference, sharing);
  return error_percent(size, size + distance, zero); // distance/size, with its care for a zero field
}

std::optional<double> measure_error_percent(const cases::Measure& measure, const cases::Scene& scene,
                                            const cases::Solution& fem, const cases::Solution& msm) {
  if (cases::is_field_norm(measure.kind))
    return field_error_percent(measure.kind, scene.mesh, fem.displacement, msm.displacement,
                               zero_of(measure, scene, fem), fem.sharing.get());
  if (is_trajectory_norm(measure) && fem.trajectory && msm.trajectory)
    return trajectory_error_percent(series_of(measure, scene, fem), series_of(measure, scene, msm));
  const auto of_fem = value_of(measure, scene, fem), of_msm = value_of(measure, scene, msm);
  if (!of_fem || !of_msm) return std::nullopt;
  return error_percent(*of_fem, *of_msm, zero_of(measure, scene, fem));
}

double zero_of_displacements(const cases::Scene& scene, const cases::Solution& solution) {
  const auto largest_of = [&](const std::vector<Vector3d>& field, const cases::Sharing* sharing) {
    return field_norm(measures::DisplacementFieldMax{}, scene.mesh, field, sharing);
  };
  const auto& motion = solution.trajectory; // every rank has all of it, and its end is one of its bodies
  if (!motion) return relative_zero * largest_of(solution.displacement, solution.sharing.get());
  double largest = largest_of(motion->displacement, nullptr);
  for (const auto& body : motion->bodies)
    largest = mechanics::larger(largest, largest_of(body.displacement, nullptr));
  return relative_zero * largest;
}

double zero_of(const cases::Measure& measure, const cases::Scene& scene, const cases::Solution& fem) {
  if (!can_evaluate(measure, fem)) return 0; // one that failed beside meshes that have a limit
  if (measure.over_time && !unit_over_time(*measure.over_time, "").empty()) return 0; // has its own
  return zero_of_values(measure, scene, fem);
}

std::string unit_of(const cases::Measure& measure) {
  const char* const unit = std::visit([](const auto& kind) { return kind.unit; }, measure.kind);
  return measure.over_time ? unit_over_time(*measure.over_time, unit) : unit;
}

std::optional<double> error_percent(double fem, double msm, double zero) {
  const double error = (msm - fem) / fem * 100;
  const bool is_zero = !(std::abs(fem) > std::max(zero, 1e-9 * std::abs(msm)));
  return std::isfinite(error) && !is_zero ? std::optional(error) : std::nullopt;
}

} // namespace springproof::compare
