#include "mechanics/contact/contact.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "cases/scene/tools.hpp"
#include "mechanics/contact/signed_distance.hpp"
#include "mechanics/elastic_moduli.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <utility>

namespace springproof::mechanics {

using Eigen::Vector3d;

namespace {

constexpr int most_augmentations = 50;
constexpr double allowed_misfit = 1e-3; ///< relative to the indentation

double modulus_of(const cases::LinearElastic& material) {
  return material.youngs_modulus;
}
/// That of an incompressible one.
double modulus_of(const cases::Ogden& material) {
  return 3 * shear_modulus(material);
}
double modulus_of(const cases::TransverselyIsotropic& material) {
  return std::max(material.youngs_modulus_along, material.youngs_modulus_across);
}

/// Calls action(vertex of the face, its share of the area, mm²) for every vertex of a face.
/// @return the face's outer normal, of unit length
template<class Action>
Vector3d share_area(const cases::Mesh& mesh, const cases::FaceNodes& face, const Action& action) {
  const auto at = [&](std::size_t v) -> Vector3d { return mesh.nodes[cases::index(face[v])]; };
  if (face.size() == 3) {
    const Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0));
    for (const int node : face) action(node, normal.norm() / 6);
    return normal.normalized();
  }
  for (const auto& [s, t, point, area] : cases::gauss_points({at(0), at(1), at(2), at(3)}, 2)) {
    const std::array<double, 4> shape{(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
    for (std::size_t v = 0; v < 4; ++v) action(face[v], shape[v] * area);
  }
  return (at(2) - at(0)).cross(at(3) - at(1)).normalized();
}

} // namespace

Contact::Contact(std::vector<ToolSide> sides) : sides_(std::move(sides)) {
  for (const ToolSide& side : sides_) multipliers_.emplace_back(side.points.size(), 0.);
}

/// Calls action(tool, point, signed distance, pressure in MPa) for every point.
template<class Action>
void Contact::for_each_point(const DisplacementAt& displacement, double load_factor,
                             const Action& action) const {
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const auto& [tool, points] = sides_[s];
    const Vector3d place = tool.place(load_factor);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d from_tool = points[i].rest + displacement(points[i].node) - place;
      const SignedDistance distance = signed_distance(tool.shape, from_tool);
      const double penalty = points[i].stiffness / points[i].area;
      action(s, i, distance, std::max(0., multipliers_[s][i] - penalty * distance.value));
    }
  }
}

void Contact::for_each_pressed(const DisplacementAt& displacement, double load_factor,
                               const std::function<void(const Pressed&)>& action) const {
  for_each_point(
      displacement, load_factor,
      [&](std::size_t s, std::size_t i, const SignedDistance& distance, double pressure) {
        if (!(pressure > 0)) return;
        const SurfacePoint& point = sides_[s].points[i];
        const Vector3d& n = distance.normal;
        const double force = pressure * point.area;
        action({point.node, force * n, point.stiffness * n * n.transpose(), force * distance.curvature});
      });
}

double Contact::energy(const DisplacementAt& displacement, double load_factor) const {
  double sum = 0;
  for_each_point(displacement, load_factor,
                 [&](std::size_t s, std::size_t i, const SignedDistance&, double pressure) {
                   const SurfacePoint& point = sides_[s].points[i];
                   sum += point.area * point.area / (2 * point.stiffness) *
                          (pressure * pressure - multipliers_[s][i] * multipliers_[s][i]);
                 });
  return sum;
}

Contact::Misfit Contact::misfit(const DisplacementAt& displacement, double load_factor) const {
  Misfit found;
  double indentation = 0, way = 0; // mm: how deep the body at rest is met; how far points are pressed
  for_each_point(displacement, load_factor,
                 [&](std::size_t s, std::size_t i, const SignedDistance& distance, double pressure) {
                   const auto& [tool, points] = sides_[s];
                   const Vector3d rest = points[i].rest - tool.place(load_factor);
                   indentation = std::max(indentation, -signed_distance(tool.shape, rest).value);
                   if (!(pressure > 0)) return;
                   way = std::max(way, displacement(points[i].node).norm());
                   if (!(std::abs(distance.value) > found.largest)) return;
                   found.largest = std::abs(distance.value);
                   found.worst = s;
                 });
  found.allowed = allowed_misfit * (indentation > 0 ? indentation : way);
  return found;
}

void Contact::augment(const DisplacementAt& displacement, double load_factor) {
  std::vector<std::vector<double>> pressures = multipliers_;
  for_each_point(displacement, load_factor,
                 [&](std::size_t s, std::size_t i, const SignedDistance&, double pressure) {
                   pressures[s][i] = pressure;
                 });
  multipliers_ = std::move(pressures);
  ++revision_;
}

void Contact::forget() {
  for (auto& of_tool : multipliers_) std::fill(of_tool.begin(), of_tool.end(), 0.);
  ++revision_;
}

std::vector<cases::ToolContact> Contact::found(const DisplacementAt& displacement, double load_factor) const {
  std::vector<cases::ToolContact> all(sides_.size());
  for_each_point(displacement, load_factor,
                 [&](std::size_t s, std::size_t i, const SignedDistance& distance, double pressure) {
                   const auto& [tool, points] = sides_[s];
                   cases::ToolContact& here = all[s];
                   here.penetration = std::max(here.penetration, -distance.value);
                   if (!(pressure > 0)) return;
                   const Vector3d force = pressure * points[i].area * distance.normal;
                   const Vector3d at = points[i].rest + displacement(points[i].node);
                   here.force += force;
                   here.torque += (at - tool.place(load_factor)).cross(force);
                   // the sides of an edge that the tool does not face are not pressed
                   here.area += std::clamp(-points[i].facing.dot(distance.normal), 0., points[i].area);
                   here.nodes.push_back(points[i].node);
                   here.on_nodes.push_back(force);
                 });
  return all;
}

double contact_modulus(const cases::Scene& scene) {
  double largest = 0;
  for (const cases::Material& material : cases::materials_of(scene.definition))
    largest = std::max(largest, std::visit([](const auto& one) { return modulus_of(one); }, material));
  return (scene.definition.dynamics ? 100 : 10) * largest;
}

std::vector<ToolSide> tool_sides(const cases::Scene& scene) {
  std::vector<ToolSide> sides;
  const double modulus = contact_modulus(scene);
  for (const cases::Tool& tool : scene.definition.tools) {
    std::map<int, SurfacePoint> of_node;
    for (const cases::FaceNodes& face : cases::touched_faces(scene, tool)) {
      double area = 0;
      const Vector3d normal = share_area(scene.mesh, face, [&](int, double share) { area += share; });
      share_area(scene.mesh, face, [&](int node, double share) {
        const SurfacePoint none{node, scene.mesh.nodes[cases::index(node)], 0, 0, Vector3d::Zero()};
        SurfacePoint& point = of_node.try_emplace(node, none).first->second;
        point.area += share;
        point.stiffness += share * Contact::penalty(modulus, std::sqrt(area));
        point.facing += share * normal;
      });
    }
    ToolSide& side = sides.emplace_back(ToolSide{tool, {}});
    for (const auto& [node, point] : of_node) side.points.push_back(point);
  }
  return sides;
}

Equilibrium find_equilibrium_in_contact(NonlinearProblem& problem, Contact* contact,
                                        const std::function<DisplacementAt(const Vector&)>& displacement_of,
                                        const Vector& start, const std::string& name,
                                        const EquilibriumSettings& settings) {
  Equilibrium found = find_equilibrium(problem, start, name, settings);
  if (!contact) return found;
  EquilibriumSettings again = settings;
  again.from = settings.to;
  again.first_load_step = again.largest_load_step = 1;
  again.guess.reset();
  for (int n = 0;; ++n) {
    const auto misfit = contact->misfit(displacement_of(found.state), settings.to);
    if (misfit.is_small()) return found;
    if (n == most_augmentations) {
      cases::Solution so_far = to_solution(found);
      so_far.outcome = cases::Outcome::unknown;
      throw cases::SolveError(
          fmt::format(
              "{}: the contact with the tool '{}' does not settle: after {} augmentations its surface "
              "and the body's differ by {:.3g} mm, more than the {:.3g} mm that are allowed",
              name, contact->sides()[misfit.worst].tool.name, n, misfit.largest, misfit.allowed),
          std::move(so_far));
    }
    contact->augment(displacement_of(found.state), settings.to);
    Equilibrium next = find_equilibrium(problem, found.state, name, again);
    next.load_steps += found.load_steps;
    next.newton_iterations += found.newton_iterations;
    next.convexified_steps += found.convexified_steps;
    next.escapes += found.escapes;
    next.work.linear_iterations += found.work.linear_iterations;
    next.work.factorisations += found.work.factorisations;
    next.work.force_evaluations += found.work.force_evaluations;
    found = std::move(next);
  }
}

} // namespace springproof::mechanics
