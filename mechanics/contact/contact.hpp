#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <functional>

/// Contact with rigid tools without friction, one law for both models. At a point of the body's surface with
/// the area A the pressure is p = max(0, lambda - epsilon g), g the signed distance from the tool at the
/// displaced point, lambda its multiplier (MPa) and epsilon a penalty (MPa/mm). Its potential
/// A (p² - lambda²)/(2 epsilon) is an augmented Lagrangian: an equilibrium is found at fixed multipliers,
/// which then take the pressure's value, until the surface is where the tool is (Uzawa). Points are nodes
/// with the integral of their shape function over the surface: forces then have a limit under refinement.
/// In a motion multipliers stay 0 and the penalty is ten times as stiff: the force is then a function of the
/// displacement alone, without a memory of earlier steps that a step taken again would have to take back.
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
    Eigen::Vector3d force;     ///< on the body, N
    Eigen::Matrix3d stiffness; ///< the penalty's, N/mm, >= 0
    Eigen::Matrix3d softening; ///< by the tool's curvature, N/mm, >= 0 and subtracted
    Eigen::Matrix3d tangent() const { return stiffness - softening; }
  };
  /// Calls action(pressed) for every point with a pressure.
  void for_each_pressed(const DisplacementAt& displacement, double load_factor,
                        const std::function<void(const Pressed&)>& action) const;

  /// Potential of the pressures, N mm.
  double energy(const DisplacementAt& displacement, double load_factor) const;

  /// How far pressed points are from the tool's surface.
  struct Misfit {
    double largest = 0;    ///< mm, of a pressed point, to either side
    double allowed = 0;    ///< mm
    std::size_t worst = 0; ///< the tool's index
    bool is_small() const { return largest <= allowed; }
  };
  Misfit misfit(const DisplacementAt& displacement, double load_factor) const;

  /// Multipliers take the pressures' values.
  void augment(const DisplacementAt& displacement, double load_factor);
  /// Multipliers become 0, as before a path from rest.
  void forget();
  /// Counts the changes of multipliers.
  int revision() const { return revision_; }

  const std::vector<ToolSide>& sides() const { return sides_; }
  /// Has a tool go where a path says from now on.  @param path  as Tool::path
  void lead(std::size_t tool, std::vector<std::array<double, 4>> path) {
    sides_[tool].tool.path = std::move(path);
  }
  /// What the tools do to the body, with the forces on nodes in the numbers of the model.
  std::vector<cases::ToolContact> found(const DisplacementAt& displacement, double load_factor) const;

 private:
  std::vector<ToolSide> sides_;
  std::vector<std::vector<double>> multipliers_; ///< MPa, for every tool one per point
  int revision_ = 0;

  template<class Action>
  void for_each_point(const DisplacementAt& displacement, double load_factor, const Action& action) const;
};

/// Young's modulus at rest of a scene's stiffest material, MPa, times 10; times 100 in a motion, where
/// nothing corrects the penalty.
double contact_modulus(const cases::Scene& scene);

/// The tools of a scene with the vertices of the faces that they may touch.
std::vector<ToolSide> tool_sides(const cases::Scene& scene);

/// Static equilibrium in contact: find_equilibrium(), and again at the same load while multipliers change.
/// Without a contact it is find_equilibrium().
/// @param contact          null: there is none
/// @param displacement_of  returns the displacements in a state, which outlives them
/// @throws cases::SolveError as find_equilibrium(), or if the multipliers do not settle
Equilibrium find_equilibrium_in_contact(NonlinearProblem& problem, Contact* contact,
                                        const std::function<DisplacementAt(const Vector&)>& displacement_of,
                                        const Vector& start, const std::string& name,
                                        const EquilibriumSettings& settings);

} // namespace springproof::mechanics
