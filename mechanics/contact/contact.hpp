#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/contact/friction.hpp"
#include "mechanics/contact/signed_distance.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <functional>

/// Contact with rigid tools, one law for both models. At a point of the body's surface with
/// the area A the pressure is p = max(0, lambda - epsilon g), g the signed distance from the tool at the
/// displaced point, lambda its multiplier (MPa) and epsilon a penalty (MPa/mm). Its potential
/// A (p² - lambda²)/(2 epsilon) is an augmented Lagrangian: an equilibrium is found at fixed multipliers,
/// which then take the pressure's value, until the surface is where the tool is (Uzawa). Points are nodes
/// with the integral of their shape function over the surface: forces then have a limit under refinement.
/// In a motion multipliers stay 0 and the penalty is ten times as stiff: the force is then a function of the
/// displacement alone, without a memory of earlier steps that a step taken again would have to take back.
/// Friction is Coulomb's, see friction(), with the penalty as its stiffness. It remembers where a point was
/// on the tool when the last step ended, and its force there, which only the end of a step changes: a step
/// that is taken again has nothing to take back. Augmentations have the friction's force too as a multiplier,
/// so that points stick without a slide; in a motion they give way by the bound over the penalty at most.
/// Source: J. C. Simo and T. A. Laursen, An augmented Lagrangian treatment of contact problems involving
/// friction, Computers & Structures 42 (1992).
namespace springproof::mechanics {

/// A node's displacement by its number, mm.
using DisplacementAt = std::function<Eigen::Vector3d(int node)>;

/// A node of the surface that a tool may touch.
struct SurfacePoint {
  int node;               ///< in the numbers of the model
  Eigen::Vector3d rest;   ///< mm
  double area;            ///< integral of its shape function over the surface at rest, mm²
  double stiffness;       ///< integral of its shape function times the penalty, N/mm
  Eigen::Vector3d facing; ///< integral of its shape function times the surface's outer normal, mm²
};

/// A tool, and what it may touch.
struct ToolSide {
  cases::Tool tool;
  std::vector<SurfacePoint> points;
};

/// What the contact of a body with its tools adds to an equilibrium, or to a motion's equations: there a load
/// factor is a time (s).
class Contact {
 public:
  /// Draws the penalty from the size of a face's side (mm).
  /// @param modulus  contact_modulus() of the scene, MPa
  static double penalty(double modulus, double size) { return modulus / size; }

  explicit Contact(std::vector<ToolSide> sides);

  /// What a pressed point adds.
  struct Pressed {
    int node;
    Eigen::Vector3d force;     ///< on the body, N, with that of friction
    Eigen::Matrix3d stiffness; ///< the penalty's and the friction's, N/mm, >= 0
    Eigen::Matrix3d softening; ///< by the tool's curvature, N/mm, subtracted
    Eigen::Matrix3d tangent() const { return stiffness - softening; }
  };
  /// Calls action(pressed) for every point with a pressure or friction.
  void for_each_pressed(const DisplacementAt& displacement, double load_factor,
                        const std::function<void(const Pressed&)>& action) const;

  /// Potential of the pressures, and of the friction with its bounds held, N mm.
  double energy(const DisplacementAt& displacement, double load_factor) const;

  /// How far pressures and friction are from their laws.
  struct Misfit {
    double change = 0;           ///< N: what augment() would change of a tool's pressures, summed over points
    double force = 0;            ///< N: the sum of its pressures; of the tool that changes most for it
    std::size_t worst = 0;       ///< that tool's index
    double friction = 0;         ///< N: the sum of what augment() would change of the points' friction
    double allowed_friction = 0; ///< N
    bool is_change_small() const { return change <= 1e-3 * force; }
    bool is_friction_small() const { return friction <= allowed_friction; }
    bool is_small() const { return is_change_small() && is_friction_small(); }
  };
  Misfit misfit(const DisplacementAt& displacement, double load_factor) const;

  /// Sets the multipliers to the pressures and the friction, and the friction's bounds with them.
  void augment(const DisplacementAt& displacement, double load_factor);
  /// Brings the friction's bounds and planes to the pressures, where that would change its forces by more
  /// than a millionth of the bounds.  @return whether there was nothing to change
  bool settle(const DisplacementAt& displacement, double load_factor);
  /// Has friction remember where points are on the tools, and its forces, from now on.
  void end_step(const DisplacementAt& displacement, double load_factor);
  /// Sets the multipliers to 0 and the memory of friction to the body at rest, as before a load path.
  void forget();
  /// Takes the pressures' multipliers of another state of the same contact, and keeps what friction knows.
  void take_pressures_of(const Contact& other) {
    multipliers_ = other.multipliers_;
    ++revision_;
  }
  bool has_friction() const;
  /// @throws cases::InputError when a tool is deeper inside the body at rest, at time 0, than a twentieth of
  /// a face's side
  void check_start() const;
  /// Whether no point passes through a tool between two states. A step in which one does leads to an
  /// equilibrium in which the point is on another side of the tool.
  /// A point passes where its straight way, seen from the tool, is deeper inside than a twentieth of a face's
  /// side and than both its ends.
  bool is_way_open(const DisplacementAt& from, double load_from, const DisplacementAt& to,
                   double load_to) const;
  /// Calls action(node, way) for every point that a tool presses in one state. The way (mm) leads the point
  /// from its place in another state to where it is as deep in the tool as in the first.
  void for_each_way_along(const DisplacementAt& from, double load_from, const DisplacementAt& to,
                          double load_to,
                          const std::function<void(int node, const Eigen::Vector3d& way)>& action) const;
  /// Counts the changes of multipliers.
  int revision() const { return revision_; }

  const std::vector<ToolSide>& sides() const { return sides_; }
  /// Sets the path of a tool, from now on.  @param path  as Tool::path
  void lead(std::size_t tool, std::vector<std::array<double, 4>> path) {
    sides_[tool].tool.path = std::move(path);
  }
  /// What the tools do to the body, with the forces on nodes in the numbers of the model.
  /// @param unbalanced  of a node, N: what its forces, the tools' among them, add up to where a solution is
  /// not exact; empty: nothing. A pressed node's force is then what the body and its inertia bear, as
  /// reactions of supports are: a displacement's error changes this by the body's stiffness, and a pressure
  /// by the penalty.
  std::vector<cases::ToolContact> found(const DisplacementAt& displacement, double load_factor,
                                        const DisplacementAt& unbalanced = {}) const;

 private:
  std::vector<ToolSide> sides_;
  std::vector<DistanceAt> distances_;            ///< one per tool
  std::vector<std::vector<double>> multipliers_; ///< MPa, for every tool one per point
  std::vector<std::vector<Grip>> grips_;         ///< likewise; none of a tool without friction
  int revision_ = 0;

  struct Touch;
  enum class Held { stays, is_augmented };
  template<class Action>
  void for_each_point(const DisplacementAt& displacement, double load_factor, const Action& action) const;
  Friction friction_at(const Touch& touch) const;
  Grip renewed(const Touch& touch, Held held) const;
};

/// Young's modulus at zero strain of a scene's stiffest material, MPa, times 10; times 100 in a motion, where
/// nothing corrects the penalty, and of the modulus before any memory has faded.
double contact_modulus(const cases::Scene& scene);

/// The tools of a scene with the vertices of the faces that they may touch.
std::vector<ToolSide> tool_sides(const cases::Scene& scene);

/// Static equilibrium in contact: find_equilibrium(), and again at the same load while multipliers change.
/// With friction this is done for every load step of the settings' largest length, at whose end it remembers
/// where points are. Without a contact it is find_equilibrium().
/// @param contact          null: there is none
/// @param displacement_of  returns the displacements in a state, which outlives them
/// @throws cases::SolveError as find_equilibrium(), or if the multipliers do not settle
Equilibrium find_equilibrium_in_contact(NonlinearProblem& problem, Contact* contact,
                                        const std::function<DisplacementAt(const Vector&)>& displacement_of,
                                        const Vector& start, const std::string& name,
                                        const EquilibriumSettings& settings);

} // namespace springproof::mechanics
