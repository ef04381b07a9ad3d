#include "fem_reference/real_time/real_time.hpp"

#include "cases/scene/loads.hpp"
#include "fem_reference/real_time/xpbd.hpp"
#include "mechanics/dynamics/follow_motion.hpp"
#include "mechanics/real_time/coming_to_rest.hpp"
#include "mechanics/real_time/points_in_time.hpp"
#include "mechanics/shape_products.hpp"

namespace springproof::fem_reference {

namespace {

using cases::ElementMethod;
using cases::index;
using mechanics::Vector;

MakeCellLaw law_of(const RestCells& cells, ElementMethod method) {
  const cases::Fem& fem = cells.scene().definition.fem;
#pragma GCC diagnostic error "-Wswitch" // a method that is forgotten here must not compile
  switch (method) {
  case ElementMethod::corotational:
    return corotational_law(cells, fem.element);
  case ElementMethod::total_lagrangian_explicit:
    return law_at_points(cells, formulations_of(cells.scene()), fem.element);
  case ElementMethod::xpbd:
    break;
  }
  return law_at_points(cells, neo_hookean(cells.scene()), fem.element);
}

mechanics::MakeStep make_step(const RestCells& cells, VertexElements& elements,
                              const cases::ElementRealTime& real_time, int n_threads) {
  switch (real_time.method) {
  case ElementMethod::corotational:
    return mechanics::make_implicit_euler(elements.forces(), elements.tangent(), real_time.iterations);
  case ElementMethod::total_lagrangian_explicit:
    return mechanics::make_symplectic_euler(elements.forces());
  case ElementMethod::xpbd:
    break;
  }
  return make_xpbd(cells, real_time.iterations, n_threads);
}

/// Sums of the rows of consistent masses, and what [[mass]] adds.
mechanics::PointBody masses_of(const cases::Scene& scene) {
  mechanics::PointBody body;
  body.mass.resize(scene.mesh.nodes.size());
  body.mass_damping.resize(scene.mesh.nodes.size());
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
    const cases::CellDynamics dynamics = cases::dynamics_of(scene, c);
    const Eigen::VectorXd masses =
        mechanics::shape_products(cases::cell_corners(scene.mesh, c), dynamics.density).rowwise().sum();
    const cases::CellNodes nodes = scene.mesh.cells[c];
    for (std::size_t v = 0; v < nodes.size(); ++v) {
      body.mass[index(nodes[v])] += masses[static_cast<Eigen::Index>(v)];
      body.mass_damping[index(nodes[v])] += dynamics.mass_damping * masses[static_cast<Eigen::Index>(v)];
    }
  }
  for (const auto& [node, mass] : cases::added_masses(scene)) body.mass[index(node)] += mass;
  return body;
}

mechanics::PointBody point_body(const cases::Scene& scene, VertexElements& elements) {
  mechanics::PointBody body = masses_of(scene);
  body.forces = elements.forces();
  body.tangent = elements.tangent();
  return body;
}

} // namespace

struct SteppedElements::Implementation {
  const cases::Scene& own;
  cases::ElementRealTime real_time;
  cases::Scene scene; ///< on the refined mesh
  RestCells cells;
  VertexElements elements;
  mechanics::PointsInTime points;
  mechanics::StateOnMesh on_mesh;
  mechanics::CameToRest rest{};

  Implementation(const cases::Scene& of, const cases::ElementRealTime& by, int n_threads)
      : own(of), real_time(by),
        scene(cases::refine(of.definition.dynamics ? of : mechanics::in_motion(of, by),
                            of.definition.fem.refine)),
        cells(scene), elements(cells, law_of(cells, by.method), n_threads),
        points(scene, point_body(scene, elements), make_step(cells, elements, by, n_threads)),
        on_mesh(own.mesh, nullptr,
                {[this](const Vector& at) { return displacements(at); },
                 [this](const Vector& at) { return volumes(at); }}) {}

  std::vector<cases::Numbered<Eigen::Vector3d>> displacements(const Vector& at) const {
    std::vector<cases::Numbered<Eigen::Vector3d>> found;
    const Points all = mechanics::to_points(at);
    for (std::size_t n = 0; n < own.mesh.nodes.size(); ++n)
      found.push_back({static_cast<std::int64_t>(n), all[n]});
    return found;
  }
  std::vector<cases::Numbered<double>> volumes(const Vector& at) const {
    std::vector<cases::Numbered<double>> found;
    const Points all = mechanics::to_points(at);
    const std::size_t n_children = scene.mesh.cells.size() / own.mesh.cells.size();
    for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
      found.push_back({static_cast<std::int64_t>(c / n_children),
                       cases::cell_volume(cases::cell_corners(scene.mesh, c, all))});
    return found;
  }

  mechanics::IntegrationSettings settings(double step) {
    return mechanics::in_substeps(real_time, [&] {
      return mechanics::stable_substeps(elements.tangent(), masses_of(scene).mass, step,
                                        cases::name_of(real_time.method), own.definition.fem.where);
    });
  }
};

SteppedElements::SteppedElements(const cases::Scene& scene, const cases::ElementRealTime& real_time,
                                 int n_threads)
    : implementation_(new Implementation(scene, real_time, n_threads)) {}
SteppedElements::~SteppedElements() = default;

cases::Solution SteppedElements::follow(const std::vector<Eigen::Vector3d>& start, StepBy by,
                                        const mechanics::StepLimits& limits) {
  Implementation& body = *implementation_;
  Points from(body.scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  std::copy(start.begin(), start.end(), from.begin());
  Vector state = mechanics::to_vector(from);
  body.points.solve_by_newton(by == StepBy::newton);
  mechanics::IntegrationSettings settings;
  if (by == StepBy::method) settings = body.settings(body.own.definition.dynamics->step);
  settings.newton.should_stop = limits.should_stop;
  return mechanics::follow_motion(body.own, body.points, body.on_mesh, state, settings);
}

cases::Solution SteppedElements::come_to_rest(const mechanics::StepLimits& limits) {
  Implementation& body = *implementation_;
  const cases::ElementRealTime& real_time = body.real_time;
  const auto displacement = [&](const Vector& at) { return body.on_mesh.whole_displacement(at); };
  const Vector start = mechanics::to_vector(Points(body.scene.mesh.nodes.size(), Eigen::Vector3d::Zero()));
  body.rest = mechanics::come_to_rest({body.points, displacement, {}}, start, real_time,
                                      body.settings(real_time.step), limits);
  cases::Solution solution = mechanics::to_solution(body.rest.work);
  body.on_mesh.add_to(solution, body.rest.state);
  mechanics::add_rest(solution, body.rest, body.points.out_of_balance(body.rest.state, body.rest.time));
  return solution;
}

mechanics::PointsInTime& SteppedElements::points() {
  return implementation_->points;
}

mechanics::IntegrationSettings SteppedElements::settings() {
  Implementation& body = *implementation_;
  return body.settings(body.own.definition.dynamics ? body.own.definition.dynamics->step
                                                    : body.real_time.step);
}

std::vector<Eigen::Vector3d> SteppedElements::equilibrium() {
  Implementation& body = *implementation_;
  return body.on_mesh.whole_displacement(body.points.balanced(body.rest.state, body.rest.time));
}

} // namespace springproof::fem_reference
