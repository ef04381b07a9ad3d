#include "mechanics/contact/contact.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "cases/scene/tools.hpp"
#include "mechanics/elastic_moduli.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace springproof::mechanics {

using Eigen::Vector3d;

namespace {

constexpr double allowed_friction = 1e-6; ///< relative to the sum of the points' bounds
constexpr double allowed_passage = 0.05; ///< depth of a point's way through a tool, relative to a face's side

double modulus_of(const cases::LinearElastic& material) {
  return material.youngs_modulus;
}
/// Those of incompressible ones.
double modulus_of(const cases::Ogden& material) {
  return 3 * at_rest(material).shear_modulus;
}
double modulus_of(const cases::Yeoh& material) {
  return 3 * at_rest(material).shear_modulus;
}
double modulus_of(const cases::TransverselyIsotropic& material) {
  return std::max(material.youngs_modulus_along, material.youngs_modulus_across);
}

/// A box that holds a tool's surface, seen from its place: all of space but for a file's, far from which
/// exact distances take long.
Eigen::AlignedBox3d box_around(const cases::tools::Kind& shape) {
  if (const auto* surface = std::get_if<cases::tools::Surface>(&shape))
    return cases::bounding_box(surface->vertices);
  return {Vector3d::Constant(-INFINITY), Vector3d::Constant(INFINITY)};
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

/// A point as a tool has it.
struct Contact::Touch {
  std::size_t side, index;
  const SurfacePoint& point;
  Vector3d from_tool; ///< mm, the point as seen from the tool's place
  SignedDistance distance;
  double pressure; ///< MPa
};

Contact::Contact(std::vector<ToolSide> sides) : sides_(std::move(sides)) {
  for (const ToolSide& side : sides_) {
    distances_.push_back(distance_from(side.tool.shape));
    multipliers_.emplace_back(side.points.size(), 0.);
    grips_.emplace_back(side.tool.friction > 0 ? side.points.size() : 0);
  }
  forget();
}

/// Calls action(touch) for every point.
template<class Action>
void Contact::for_each_point(const DisplacementAt& displacement, double load_factor,
                             const Action& action) const {
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const auto& [tool, points] = sides_[s];
    const Vector3d place = tool.place(load_factor);
    const Eigen::AlignedBox3d box = box_around(tool.shape);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d from_tool = points[i].rest + displacement(points[i].node) - place;
      const double penalty = points[i].stiffness / points[i].area, reach = multipliers_[s][i] / penalty;
      const double beyond = box.exteriorDistance(from_tool); // what is out of reach has no pressure
      const SignedDistance distance =
          beyond > reach ? SignedDistance{beyond, Vector3d::UnitZ()} : distances_[s](from_tool);
      const double pressure = std::max(0., multipliers_[s][i] - penalty * distance.value);
      action(Touch{s, i, points[i], from_tool, distance, pressure});
    }
  }
}

Friction Contact::friction_at(const Touch& touch) const {
  if (grips_[touch.side].empty()) return {};
  return friction(grips_[touch.side][touch.index], touch.point.stiffness, touch.from_tool);
}

/// Returns what friction goes by once bound and plane are those of the pressure.
Grip Contact::renewed(const Touch& touch, Held held) const {
  Grip next = grips_[touch.side][touch.index];
  next.normal = touch.distance.normal;
  next.bound = sides_[touch.side].tool.friction * touch.pressure * touch.point.area;
  if (held == Held::is_augmented) next.held = friction(next, touch.point.stiffness, touch.from_tool).force;
  return next;
}

void Contact::for_each_pressed(const DisplacementAt& displacement, double load_factor,
                               const std::function<void(const Pressed&)>& action) const {
  for_each_point(displacement, load_factor, [&](const Touch& touch) {
    const Friction rubbed = friction_at(touch);
    const bool is_pressed = touch.pressure > 0;
    if (!is_pressed && rubbed.force.isZero(0)) return;
    const Vector3d& n = touch.distance.normal;
    const double force = touch.pressure * touch.point.area;
    const double stiffness = is_pressed ? touch.point.stiffness : 0;
    action({touch.point.node, force * n + rubbed.force, stiffness * n * n.transpose() + rubbed.stiffness,
            force * touch.distance.curvature});
  });
}

double Contact::energy(const DisplacementAt& displacement, double load_factor) const {
  double sum = 0;
  for_each_point(displacement, load_factor, [&](const Touch& touch) {
    const double multiplier = multipliers_[touch.side][touch.index];
    sum += touch.point.area * touch.point.area / (2 * touch.point.stiffness) *
           (touch.pressure * touch.pressure - multiplier * multiplier);
    sum += friction_at(touch).energy;
  });
  return sum;
}

Contact::Misfit Contact::misfit(const DisplacementAt& displacement, double load_factor) const {
  constexpr double rounding = 1e-13; // relative error of places
  Misfit found;
  std::vector<double> change(sides_.size()), force(sides_.size()); // N, of each tool
  for_each_point(displacement, load_factor, [&](const Touch& touch) {
    if (!grips_[touch.side].empty()) {
      const Grip next = renewed(touch, Held::is_augmented);
      found.friction +=
          (friction(next, touch.point.stiffness, touch.from_tool).force - friction_at(touch).force).norm();
      found.allowed_friction += allowed_friction * next.bound;
    }
    if (!(touch.pressure > 0)) return;
    force[touch.side] += touch.pressure * touch.point.area;
    const double apart = std::abs(touch.distance.value);
    if (apart > rounding * (touch.point.rest.norm() + touch.from_tool.norm()))
      change[touch.side] += touch.point.stiffness * apart;
  });
  for (std::size_t side = 0; side < sides_.size(); ++side)
    if (change[side] * found.force >= found.change * force[side] && change[side] > 0) {
      found.change = change[side];
      found.force = force[side];
      found.worst = side;
    }
  return found;
}

void Contact::augment(const DisplacementAt& displacement, double load_factor) {
  std::vector<std::vector<double>> pressures = multipliers_;
  std::vector<std::vector<Grip>> grips = grips_;
  for_each_point(displacement, load_factor, [&](const Touch& touch) {
    pressures[touch.side][touch.index] = touch.pressure;
    if (!grips_[touch.side].empty()) grips[touch.side][touch.index] = renewed(touch, Held::is_augmented);
  });
  multipliers_ = std::move(pressures);
  grips_ = std::move(grips);
  ++revision_;
}

bool Contact::settle(const DisplacementAt& displacement, double load_factor) {
  if (!has_friction()) return true;
  double change = 0, allowed = 0; // N
  std::vector<std::vector<Grip>> grips = grips_;
  for_each_point(displacement, load_factor, [&](const Touch& touch) {
    if (grips_[touch.side].empty()) return;
    const Grip next = grips[touch.side][touch.index] = renewed(touch, Held::stays);
    change +=
        (friction(next, touch.point.stiffness, touch.from_tool).force - friction_at(touch).force).norm();
    allowed += allowed_friction * next.bound;
  });
  if (change <= allowed) return true;
  grips_ = std::move(grips);
  ++revision_;
  return false;
}

void Contact::end_step(const DisplacementAt& displacement, double load_factor) {
  if (!has_friction()) return;
  std::vector<std::vector<Grip>> grips = grips_;
  for_each_point(displacement, load_factor, [&](const Touch& touch) {
    if (grips_[touch.side].empty()) return;
    grips[touch.side][touch.index].held = friction_at(touch).force;
    grips[touch.side][touch.index].anchor = touch.from_tool;
  });
  grips_ = std::move(grips);
  ++revision_;
}

void Contact::forget() {
  for (auto& of_tool : multipliers_) std::fill(of_tool.begin(), of_tool.end(), 0.);
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const auto& [tool, points] = sides_[s];
    const Vector3d place = tool.place(0);
    for (std::size_t i = 0; i < grips_[s].size(); ++i) {
      grips_[s][i] = {};
      grips_[s][i].anchor = points[i].rest - place;
    }
  }
  ++revision_;
}

void Contact::check_start() const {
  for_each_point(
      [](int) -> Vector3d { return Vector3d::Zero(); }, 0,
      [&](const Touch& touch) {
        const double depth = -touch.distance.value;
        if (!(depth > allowed_passage * std::sqrt(touch.point.area))) return;
        const cases::Tool& tool = sides_[touch.side].tool;
        cases::refuse(
            tool.where,
            "is {:.3g} mm inside the body at time 0, must be outside: a motion starts with the body at "
            "rest; move the tool away, and let its history or path bring it to the body",
            depth);
      });
}

bool Contact::has_friction() const {
  return std::any_of(grips_.begin(), grips_.end(), [](const auto& of_tool) { return !of_tool.empty(); });
}

bool Contact::is_way_open(const DisplacementAt& from, double load_from, const DisplacementAt& to,
                          double load_to) const {
  for (std::size_t side = 0; side < sides_.size(); ++side) {
    const auto& [tool, points] = sides_[side];
    const Vector3d before = tool.place(load_from), after = tool.place(load_to);
    const Eigen::AlignedBox3d box = box_around(tool.shape);
    for (const SurfacePoint& point : points) {
      const Vector3d begin = point.rest + from(point.node) - before,
                     end = point.rest + to(point.node) - after;
      if (box.exteriorDistance(begin) > (end - begin).norm()) continue; // far from a file's surface
      const auto distance = [&](double part) { return distances_[side](begin + part * (end - begin)).value; };
      const double at_begin = distance(0), at_end = distance(1), way = (end - begin).norm(),
                   passage = allowed_passage * std::sqrt(point.area),
                   allowed = std::min({0., at_begin, at_end}) - passage;
      // no place between is nearer to the tool than this
      if ((at_begin + at_end - way) / 2 >= allowed) continue;
      // A distance changes by at most the way: no place is left out that is deeper by a quarter of the
      // passage. Vertices of quadratic faces have no area, and so no passage.
      const double least = std::max(passage / 4, way / 1000);
      for (double gone = at_begin - allowed; gone < way;) {
        const double above = distance(gone / way) - allowed;
        if (above < 0) return false;
        gone += std::max(above, least);
      }
    }
  }
  return true;
}

void Contact::for_each_way_along(const DisplacementAt& from, double load_from, const DisplacementAt& to,
                                 double load_to,
                                 const std::function<void(int node, const Vector3d& way)>& action) const {
  for_each_point(from, load_from, [&](const Touch& touch) {
    if (!(touch.pressure > 0)) return;
    const Vector3d place = touch.point.rest + to(touch.point.node) - sides_[touch.side].tool.place(load_to);
    const SignedDistance there = distances_[touch.side](place);
    action(touch.point.node, (touch.distance.value - there.value) * there.normal);
  });
}

std::vector<cases::ToolContact> Contact::found(const DisplacementAt& displacement, double load_factor,
                                               const DisplacementAt& unbalanced) const {
  std::vector<cases::ToolContact> all(sides_.size());
  std::map<int, int> n_tools; // that act on a node, and share what it leaves
  if (unbalanced && sides_.size() > 1)
    for_each_pressed(displacement, load_factor, [&](const Pressed& pressed) { ++n_tools[pressed.node]; });
  for_each_point(displacement, load_factor, [&](const Touch& touch) {
    cases::ToolContact& here = all[touch.side];
    here.penetration = std::max(here.penetration, -touch.distance.value);
    const Vector3d rubbed = friction_at(touch).force;
    if (!(touch.pressure > 0) && rubbed.isZero(0)) return;
    const Vector3d& normal = touch.distance.normal;
    Vector3d force = touch.pressure * touch.point.area * normal + rubbed;
    if (unbalanced) {
      const Vector3d left =
          unbalanced(touch.point.node) / (sides_.size() > 1 ? n_tools[touch.point.node] : 1);
      force -= grips_[touch.side].empty() ? Vector3d(normal.dot(left) * normal) : left;
    }
    here.force += force;
    here.torque += touch.from_tool.cross(force);
    // the sides of an edge that the tool does not face are not pressed
    if (touch.pressure > 0) here.area += std::clamp(-touch.point.facing.dot(normal), 0., touch.point.area);
    here.nodes.push_back(touch.point.node);
    here.on_nodes.push_back(force);
  });
  return all;
}

double contact_modulus(const cases::Scene& scene) {
  const std::vector<cases::Material> materials = cases::materials_of(scene.definition);
  double largest = 0;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const double at_rest = std::visit([](const auto& one) { return modulus_of(one); }, materials[m]);
    double g = 0, k = 0; // a memory makes a body stiffer against what comes at once
    if (scene.definition.dynamics)
      for (const cases::PronyTerm& term : cases::dynamics_of(scene.definition, m).prony)
        g += term.g, k += term.k;
    largest = std::max(largest, at_rest / (1 - std::max(g, k)));
  }
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

} // namespace springproof::mechanics
