#include "compare/gates/comparison.hpp"
#include "compare/measure/measure.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace springproof;
namespace measures = cases::measures;

using cases::OverTime;
using Eigen::Vector3d;

namespace {

cases::Scene cube() {
  cases::Case definition;
  definition.body = cases::Box{{2, 2, 2}, {2, 2, 2}};
  return cases::make_scene(definition);
}

template<class Motion>
cases::Solution moved(const cases::Scene& scene, const Motion& motion) {
  cases::Solution solution;
  solution.status = cases::Status::converged;
  for (const Vector3d& x : scene.mesh.nodes) solution.displacement.push_back(motion(x) - x);
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    solution.cell_volume.push_back(
        cases::cell_volume(cases::cell_corners(scene.mesh, c, solution.displacement)));
  return solution;
}

const cases::Region corner{"z+ x+ y+"};

/// A motion of the corner, mm once a second; the others rest. All of it is kept of the two ends.
cases::Solution in_time(const cases::Scene& scene, const std::vector<Vector3d>& course) {
  cases::Solution solution = moved(scene, [](const Vector3d& x) { return x; });
  const int node = cases::select_node(scene.mesh, corner);
  cases::Trajectory& motion = solution.trajectory.emplace();
  motion.nodes = {node};
  motion.displacement = course;
  for (std::size_t i = 0; i < course.size(); ++i) motion.time.push_back(static_cast<double>(i));
  motion.bodies.push_back({0, solution.displacement});
  solution.displacement[cases::index(node)] = course.back();
  motion.bodies.push_back({static_cast<int>(course.size()) - 1, solution.displacement});
  return solution;
}

constexpr double rounding = 1e-12; ///< relative to numbers of order 1 to 100

} // namespace

TEST_CASE("a twist about z is measured as the angle turned, beyond a right angle and in both senses") {
  const cases::Scene scene = cube();
  const cases::Measure twist{"m", measures::Twist{{"z+ x- y-"}, {"", Vector3d(1, 1, 2)}}};
  for (double degrees : {-170.0, -30.0, 0.0, 5.0, 120.0, 179.0}) {
    const Eigen::AngleAxisd turn(degrees * M_PI / 180, Vector3d::UnitZ());
    const auto solution =
        moved(scene, [&](const Vector3d& x) { return Vector3d(turn * x + Vector3d(3, -1, 7)); });
    CHECK(compare::evaluate(twist, scene, solution) == Approx(degrees).margin(100 * rounding));
  }
}

TEST_CASE("a simple shear tilts the vertical edge by the arc tangent of its amount") {
  const cases::Scene scene = cube();
  measures::Tilt tilt{{"z+ x- y-"}, {"z- x- y-"}};
  const auto sheared =
      moved(scene, [](const Vector3d& x) { return Vector3d(x.x() + 0.4 * x.z(), x.y(), x.z()); });
  CHECK(compare::evaluate({"m", tilt}, scene, sheared) ==
        Approx(std::atan(0.4) * 180 / M_PI).epsilon(rounding));
  tilt.toward = cases::Axis::y;
  CHECK(compare::evaluate({"m", tilt}, scene, sheared) == Approx(0).margin(rounding));
}

TEST_CASE("a coordinate is a place, a displacement a change, and the volume follows the stretch") {
  const cases::Scene scene = cube();
  const auto stretched =
      moved(scene, [](const Vector3d& x) { return Vector3d(0.5 * x.x(), x.y(), 3 * x.z()); });
  const auto value = [&](const measures::Kind& kind) {
    return compare::evaluate({"m", kind}, scene, stretched);
  };
  CHECK(value(measures::Coordinate{corner}) == Approx(6).epsilon(rounding));
  CHECK(value(measures::Displacement{corner}) == Approx(std::hypot(1.0, 4.0)).epsilon(rounding));
  CHECK(value(measures::Displacement{corner, cases::Component::x}) == Approx(-1).epsilon(rounding));
  CHECK(value(measures::Volume{}) == Approx(12).epsilon(rounding));
}

TEST_CASE("a tensor's components, von Mises equivalent and principal values") {
  using cases::TensorComponent;
  const cases::SymmetricTensor uniaxial{3, 0, 0, 0, 0, 0}, shear{0, 0, 0, 0, 2, 0}, any{1, 2, 3, 4, 5, 6};
  CHECK(compare::component_of(any, TensorComponent::zz) == 3);
  CHECK(compare::component_of(any, TensorComponent::xz) == 6);
  CHECK(compare::component_of(uniaxial, TensorComponent::von_mises) == Approx(3).epsilon(rounding));
  CHECK(compare::von_mises(shear) == Approx(2 * std::sqrt(3.0)).epsilon(rounding));
  CHECK(compare::von_mises({5, 5, 5, 0, 0, 0}) == Approx(0).margin(rounding));
  CHECK(compare::component_of(shear, TensorComponent::principal_1) == Approx(2).epsilon(rounding));
  CHECK(compare::component_of(shear, TensorComponent::principal_2) == Approx(0).margin(rounding));
  CHECK(compare::component_of(shear, TensorComponent::principal_3) == Approx(-2).epsilon(rounding));
}

TEST_CASE(
    "forces, energy and stress are read off the fields: a region's sum, all cells' sum, the mean of the "
    "cells at a point") {
  const cases::Scene scene = cube();
  auto fem = moved(scene, [](const Vector3d& x) { return Vector3d(1.1 * x); });
  const cases::Measure energy{"m", measures::StrainEnergy{}};
  CHECK_FALSE(compare::can_evaluate(energy, fem));
  CHECK(compare::can_evaluate({"m", measures::Volume{}}, fem));
  cases::Fields fields;
  for (const Vector3d& x : scene.mesh.nodes)
    fields.reaction.push_back(x.z() < 1e-9 ? Vector3d(1, 2, 2) : Vector3d(0, 0, 0));
  for (std::size_t c = 0; c < 8; ++c) {
    fields.strain_energy.push_back(0.5);
    fields.stress.push_back({double(c), 0, 0, 0, 0, 0});
    fields.strain.push_back({0, 0, 0.1 * double(c), 0, 0, 0});
  }
  fields.total_energy = 4;
  fem.fields = fields;
  CHECK(compare::can_evaluate(energy, fem));
  CHECK(compare::evaluate(energy, scene, fem) == 4);
  const auto value = [&](const measures::Kind& kind) { return compare::evaluate({"m", kind}, scene, fem); };
  const cases::Measure reaction{"m", measures::Reaction{{"z-"}}};
  CHECK(compare::evaluate(reaction, scene, fem) == Approx(27).epsilon(rounding)); // nine nodes
  CHECK(value(measures::Reaction{{"z-"}, cases::Component::y}) == 18);
  using cases::TensorComponent;
  const cases::Measure stress{"m", measures::Stress{{TensorComponent::xy, {0.5, 0.5, 0.5}}}};
  const measures::OfCells upper{TensorComponent::zz, {1, 1, 1.5}}; // four cells
  CHECK(value(measures::Stress{{TensorComponent::xx, {1.5, 0.5, 0.5}}}) == 1);
  CHECK(value(measures::Stress{{TensorComponent::xx, upper.point}}) == 5.5);
  CHECK(value(measures::Strain{upper}) == Approx(0.55).epsilon(rounding));
  CHECK(compare::unit_of(reaction) == "N");
  CHECK(compare::unit_of(energy) == "N mm");
  CHECK(compare::unit_of(stress) == "MPa");
  CHECK(compare::unit_of({"m", measures::Strain{}}) == "1");
  auto network = fem; // whose springs belong to no cell
  network.fields->has_stress = false;
  CHECK_FALSE(compare::can_evaluate(stress, network));
  CHECK(compare::can_evaluate(energy, network));
  // what a solve leaves of a stress that is zero has no percentage
  auto msm = fem;
  fem.fields->stress[0] = {1, 0, 0, 1e-9, 0, 0};
  msm.fields->stress[0] = {1, 0, 0, 3e-9, 0, 0};
  CHECK_FALSE(compare::measure_error_percent(stress, scene, fem, msm));
}

TEST_CASE("field norms: a stretch along z has the root mean square of a linear field, and errors are of the "
          "difference") {
  const cases::Scene scene = cube(); // 2 mm
  const auto along_z = [&](double strain) {
    return moved(scene, [=](const Vector3d& x) { return Vector3d(x.x(), x.y(), (1 + strain) * x.z()); });
  };
  const auto fem = along_z(0.3), msm = along_z(0.2);
  const cases::Measure l2{"m", measures::DisplacementFieldL2{}};
  const cases::Measure largest{"m", measures::DisplacementFieldMax{}};
  CHECK(compare::evaluate(l2, scene, fem) ==
        Approx(0.3 * 2 / std::sqrt(3.0)).epsilon(rounding)); // mean of z² is 4/3
  CHECK(compare::evaluate(largest, scene, fem) == Approx(0.6).epsilon(rounding));
  for (const cases::Measure& norm : {l2, largest})
    CHECK(*compare::measure_error_percent(norm, scene, fem, msm) == Approx(100 / 3.0).epsilon(rounding));
  const auto rest = along_z(0);
  CHECK_FALSE(compare::measure_error_percent(l2, scene, rest, msm));
}

TEST_CASE("the norm of a field one of whose displacements is not a number is none") {
  const cases::Scene scene = cube();
  auto solution = moved(scene, [](const Vector3d& x) { return Vector3d(2 * x); });
  solution.displacement[1].y() = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(compare::evaluate({"m", measures::DisplacementFieldL2{}}, scene, solution)));
  CHECK(std::isnan(compare::evaluate({"m", measures::DisplacementFieldMax{}}, scene, solution)));
}

TEST_CASE("the relative error has no value where the reference is zero or a side is not a number") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(*compare::error_percent(2, 3, 0) == Approx(50));
  CHECK(*compare::error_percent(-2, -3, 0) == Approx(50));
  CHECK(*compare::error_percent(2, 0, 0) == Approx(-100));
  CHECK_FALSE(compare::error_percent(0, 3, 0));
  CHECK_FALSE(compare::error_percent(0, 0, 0));
  CHECK_FALSE(compare::error_percent(1e-17, 1, 0));
  CHECK_FALSE(compare::error_percent(1e-9, 2e-9, 1e-8));
  CHECK(*compare::error_percent(2e-8, 3e-8, 1e-8) == Approx(50));
  CHECK_FALSE(compare::error_percent(nan, 1, 0));
  CHECK_FALSE(compare::error_percent(1, nan, 0));
  CHECK_FALSE(compare::error_percent(1, infinity, 0));
}

TEST_CASE("what rounding leaves of a displacement or an angle that is zero has no percentage") {
  const cases::Scene scene = cube(); // 2 mm
  const auto sheared = [&](double noise) {
    return moved(scene,
                 [=](const Vector3d& x) { return Vector3d(x.x(), x.y() + noise * x.z(), 1.3 * x.z()); });
  };
  const cases::Measure across{"m", measures::Displacement{corner, cases::Component::y}},
      along{"m", measures::Displacement{corner, cases::Component::z}},
      tilt{"m", measures::Tilt{corner, {"z- x+ y+"}, cases::Axis::y}};
  for (const double noise : {1e-16, 1e-10}) {
    const auto fem = sheared(noise), msm = sheared(-0.36 * noise);
    CHECK_FALSE(compare::measure_error_percent(across, scene, fem, msm)); // -136 %
    CHECK_FALSE(compare::measure_error_percent(tilt, scene, fem, msm));
    CHECK(*compare::measure_error_percent(along, scene, fem, msm) == Approx(0).margin(1e-12));
  }
  CHECK(*compare::measure_error_percent(across, scene, sheared(1e-6), sheared(2e-6)) ==
        Approx(100).epsilon(1e-6));
  CHECK(*compare::measure_error_percent(tilt, scene, sheared(1e-6), sheared(2e-6)) ==
        Approx(100).epsilon(1e-6));
}

TEST_CASE("an expectation is met on its closed interval alone, and never by a value that is missing or not a "
          "number") {
  cases::Expectation expectation{
      "m", cases::Quantity::error_percent, {-8, 0}, cases::ReferenceKind::published, "", {}};
  const auto judged = [&](const std::vector<compare::MeasuredValue>& measures) {
    cases::Scene scene;
    scene.definition.expectations = {expectation};
    return compare::judge(scene, {}, measures, nullptr).front();
  };
  const auto is_met = [&](std::optional<double> error) {
    return judged({{"m", "mm", 1.0, 1.0, error}}).met();
  };
  CHECK(is_met(-8));
  CHECK(is_met(0));
  CHECK_FALSE(is_met(0.001));
  CHECK_FALSE(is_met(-8.001));
  CHECK_FALSE(is_met(std::nullopt));
  CHECK_FALSE(is_met(std::numeric_limits<double>::quiet_NaN()));
  CHECK_FALSE(judged({}).met());
  CHECK(judged({{"other", "mm", 1.0, 1.0, -1.0}}).missed == "there is no such measure");
  expectation.quantity = cases::Quantity::fem;
  expectation.interval = {1, 1};
  CHECK(is_met(std::nullopt)); // fem = 1 is judged, not the error
}

TEST_CASE("a statistic of cells is of those with a face in the region, weighted by their volumes") {
  const cases::Scene scene = cube(); // 2 x 2 x 2 cells
  cases::Solution solution = moved(scene, [](const Vector3d& x) { return x; });
  solution.fields.emplace();
  for (int c = 0; c < 8; ++c) solution.fields->strain.push_back({c + 1., 0, 0, 0, 0, 0}); // x runs fastest
  const auto value = [&](cases::Statistic statistic, const std::string& where) {
    const measures::OfCells component{cases::TensorComponent::principal_1, {}, {}, statistic, {where}};
    return compare::evaluate({"m", measures::Strain{component}}, scene, solution);
  };
  using cases::Statistic;
  CHECK(value(Statistic::largest, "") == 8);
  CHECK(value(Statistic::largest, "z-") == 4);
  CHECK(value(Statistic::mean, "z-") == Approx(2.5).epsilon(rounding));
  CHECK(value(Statistic::deviation, "z-") == Approx(std::sqrt(1.25)).epsilon(rounding));
  CHECK(value(Statistic::mean, "") == Approx(4.5).epsilon(rounding));
  for (const std::size_t cell : {0, 7}) { // the first, which others follow, and the last
    const double strain_of_cell = solution.fields->strain[cell][0];
    solution.fields->strain[cell][0] = std::numeric_limits<double>::quiet_NaN();
    for (const Statistic statistic : {Statistic::largest, Statistic::mean, Statistic::deviation})
      CHECK(std::isnan(value(statistic, "")));
    solution.fields->strain[cell][0] = strain_of_cell;
  }
}

TEST_CASE("the curvature of a line that is bent to a circle is the inverse of its radius") {
  const cases::Scene scene = cube();
  const double radius = 3;
  const auto bent = moved(scene, [&](const Vector3d& x) {
    const double angle = x.x() / radius;
    return Vector3d(radius * std::sin(angle), x.y(), x.z() + radius * (1 - std::cos(angle)));
  });
  const auto curvature = [&](const char* where, cases::Axis axis, const cases::Solution& solution) {
    return compare::evaluate({"m", measures::Curvature{{where}, axis}}, scene, solution);
  };
  for (const char* where : {"z+", "z+ y-"})
    CHECK(curvature(where, cases::Axis::x, bent) == Approx(1 / radius).epsilon(1e-12)); // rounding
  CHECK(curvature("z+", cases::Axis::y, bent) == 0);                                    // stays straight
  CHECK(compare::unit_of({"m", measures::Curvature{}}) == "1/mm");
  auto broken = bent; // one node of the first of three lines
  broken.displacement[cases::index(cases::select_node(scene.mesh, {"x- y- z+"}))].z() =
      std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(curvature("z+", cases::Axis::x, broken)));
}

TEST_CASE("the end of a motion that has come to rest has no percentage: zero is by the largest displacement "
          "on the way") {
  const cases::Scene scene = cube();
  const cases::Measure end{"m", measures::Displacement{corner, cases::Component::z}, {}, OverTime::end};
  const auto ends_at = [&](double z) {
    return in_time(scene, {{0, 0, 0}, {0, 0, 1}, {0, 0, -0.5}, {0, 0, z}});
  };
  const cases::Measure l2{"m", measures::DisplacementFieldL2{}};
  for (const cases::Measure& of_end : {end, l2}) {
    CHECK_FALSE(compare::measure_error_percent(of_end, scene, ends_at(1e-12), ends_at(3e-9)));
    CHECK_FALSE(compare::measure_error_percent(of_end, scene, ends_at(0), ends_at(0)));
    CHECK(compare::measure_error_percent(of_end, scene, ends_at(1e-4), ends_at(2e-4)).value() ==
          Approx(100).epsilon(1e-9)); // rounding of 1e-16 mm in 1e-4
  }
}

TEST_CASE("what rounding leaves of a course that is zero has no error, swings or turns") {
  const cases::Scene scene = cube();
  cases::Measure across{"m", measures::Displacement{corner, cases::Component::x}};
  const auto trembling = [&](double size, double way) {
    std::vector<Vector3d> course; // four swings of ten steps each
    for (int i = 0; i <= 40; ++i) course.emplace_back(size * std::sin(2 * M_PI * i / 10), 0, way * i / 40);
    return in_time(scene, course);
  };
  const auto value = [&](OverTime what, const cases::Solution& solution) {
    across.over_time = what;
    return compare::value_of(across, scene, solution);
  };
  const auto error = [&](OverTime what, const cases::Solution& fem, const cases::Solution& msm) {
    across.over_time = what;
    return compare::measure_error_percent(across, scene, fem, msm);
  };
  const cases::Solution fem = trembling(9e-16, 1), msm = trembling(-2e-15, 1);
  for (const OverTime what :
       {OverTime::frequency, OverTime::damping_ratio, OverTime::peak_time, OverTime::overshoot})
    CHECK_FALSE(value(what, fem));
  for (const OverTime what : {OverTime::trajectory_l2, OverTime::peak, OverTime::settled, OverTime::end}) {
    CHECK(value(what, fem));
    CHECK_FALSE(error(what, fem, msm));
  }
  // The same numbers of a body that moves by no more are a motion.
  const cases::Solution small = trembling(9e-16, 0);
  CHECK(value(OverTime::frequency, small));
  CHECK(error(OverTime::trajectory_l2, small, msm));
  // Where the watched node rests, what is kept of the others tells how far the body moves.
  cases::Solution elsewhere = small;
  elsewhere.trajectory->bodies.front().displacement.front() = {0, 1, 0};
  CHECK_FALSE(value(OverTime::frequency, elsewhere));
  CHECK_FALSE(error(OverTime::trajectory_l2, elsewhere, msm));
}

TEST_CASE("the error of a course one of whose values is not a number is none") {
  const cases::Scene scene = cube();
  const cases::Measure course{"m", measures::Displacement{corner}, {}, OverTime::trajectory_l2};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const cases::Solution good = in_time(scene, {{0, 0, 0}, {0, 0, 1}}),
                        bad = in_time(scene, {{0, 0, nan}, {0, 0, 1}});
  CHECK_FALSE(compare::measure_error_percent(course, scene, good, bad));
  CHECK_FALSE(compare::measure_error_percent(course, scene, bad, good));
}
