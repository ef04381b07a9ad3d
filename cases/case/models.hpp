#pragma once

#include "cases/case/designs.hpp"
#include "cases/case/dynamics.hpp"
#include "cases/case/error.hpp"
#include "cases/case/material.hpp"
#include "cases/case/spring_law.hpp"
#include "cases/case/steps_by.hpp"

#include <array>
#include <optional>
#include <vector>

/// [fem] and [msm] of a case file.
namespace springproof::cases {

SPRINGPROOF_ENUMERATION(Formulation, small_strain, saint_venant_kirchhoff, log_strain, hyperelastic)
SPRINGPROOF_ENUMERATION(Element, q1, q1_bbar, q1_p0, q1_wilson, q2, q2_p1, p1, p2, p2_p0, p2_p1)

/// Properties that a converged side must not have, unless its case accepts them.
SPRINGPROOF_ENUMERATION(Doubt,
                        inverted, ///< has cells with a corner Jacobian <= 0
                        unstable  ///< its tangent has negative eigenvalues
)

/// How simulators make a step of springs: by an amount of work that is given, whatever it leaves. All but the
/// last go towards implicit Euler's step.
SPRINGPROOF_ENUMERATION(
    StepMethod,
    xpbd,                 ///< projections on one constraint after the other (Macklin et al. 2016)
    projective_dynamics,  ///< a factorised constant matrix for all of them (Bouaziz et al. 2014)
    vertex_block_descent, ///< Newton's step of one node after the other (Chen et al. 2024)
    implicit_euler,       ///< conjugate gradients for Newton's steps (Baraff and Witkin 1998)
    symplectic_euler      ///< explicit: forces of where the step begins
)
inline bool is_explicit(StepMethod method) {
  return method == StepMethod::symplectic_euler;
}

using RealTime = StepsBy<StepMethod>;
SPRINGPROOF_FIELDS(RealTime, method, iterations, substeps, chebyshev, step, end, damping)
SPRINGPROOF_FIELDS(ElementRealTime, method, iterations, substeps, chebyshev, step, end, damping)

struct Fem {
  Formulation formulation = Formulation::log_strain;
  Element element = Element::q1_bbar;
  bool has_auto_element = true;      ///< named by no case file: the default of the mesh's shape
  int refine = 0;                    ///< uniform refinements of the body's mesh, FEM side only
  bool has_auto_formulation = false; ///< small_strain where the strains allow it, else the formulation above
  bool has_auto_accuracy = false;    ///< further meshes until the limit is known well enough
  std::vector<Doubt> accepted;       ///< doubts not held against the side
  ElementMass mass = ElementMass::consistent; ///< beside real_time lumped
  Where where;
  std::optional<ElementRealTime> real_time{}; ///< absent: every equation is solved
};
SPRINGPROOF_FIELDS(Fem, formulation, element, has_auto_element, refine, has_auto_formulation,
                   has_auto_accuracy, accepted, mass, where, real_time)

/// Homogeneous deformations that the multi-load design is fitted to.
SPRINGPROOF_ENUMERATION(LoadPath,
                        uniaxial,    ///< along a lattice axis, free sides
                        equibiaxial, ///< along two lattice axes, the third free
                        pure_shear,  ///< planar tension: one axis stretched, one held, the third free
                        simple_shear ///< between two lattice axes
)

/// How the springs' equilibrium is computed. All but the first are for comparison.
SPRINGPROOF_ENUMERATION(
    Solver,
    newton,        ///< Newton's method with load steps
    force_scaling, ///< every point moves by a multiple of its force (Brown; thesis eq. 2.11)
    fire,          ///< damped inertial relaxation (Bitzek et al. 2006)
    lbfgs,         ///< limited-memory quasi-Newton
    snes           ///< PETSc's Newton method with an assembled matrix, on all ranks
)

/// Number of times that force scaling moves the points, whether that is enough or not: in some load steps,
/// and in further iterations at full load.
struct RelaxationCounts {
  int load_steps = 1;
  int per_step = 0; ///< iterations after every load step
  int further = 0;  ///< iterations after those of the last load step
  long all() const { return static_cast<long>(load_steps) * per_step + further; }
};
SPRINGPROOF_FIELDS(RelaxationCounts, load_steps, per_step, further)

struct Msm {
  Design design = Design::linear_method;
  /// Neither the design nor what belongs to one is named: tetrahedra have a default of their own.
  bool has_auto_design = false;
  Solver solver = Solver::newton;
  std::optional<double> poissons_ratio; ///< design from another nu than the material's
  std::optional<double> split; ///< t of the moduli, hybrid, matched, midline and multi_load designs, 0 to 1
  std::optional<double> beta;  ///< resistance to bending over a slender bar's; midline
  std::optional<std::array<double, 3>> stiffness; ///< N/m: k_e, k_f, k_d; design = "given"
  /// N/m: k_e along x, y, z; k_f in the faces across x, y, z; k_d; design = "given", in place of stiffness
  std::optional<std::array<double, 7>> axis_stiffness;
  std::optional<double> uniform_stiffness;       ///< every spring's, N/m; design = "uniform"
  double volume_stiffness = 0;                   ///< MPa: k_v; design = "given"
  std::optional<NamedFile> network;              ///< design = "network", CSV: read_network()
  std::optional<SpringLaw> law{};                ///< where it is other than the design's own
  std::optional<std::array<double, 3>> exponent; ///< p of edges, face and internal diagonals; power_log. The
                                                 ///< matched design finds its own where there is none
  std::vector<LoadPath> paths;                   ///< multi_load; empty: all
  std::vector<double> weights;                   ///< multi_load; one per path, >= 0; empty: all 1
  std::optional<std::array<double, 2>> strain_range; ///< matched, multi_load, nonlinear_method: logarithmic
  bool has_volume_term = true;                       ///< multi_load: springs and k_v, or springs alone
  std::vector<Doubt> accepted;                       ///< doubts not held against the side
  PointMass mass = PointMass::cells;
  std::optional<int> iterations_per_step; ///< conjugate gradients in a step in time, as in a simulator
  Where where;
  std::optional<RelaxationCounts> relaxation{}; ///< force_scaling; absent: it runs until equilibrium
  std::optional<RealTime> real_time{};          ///< absent: every equation is solved
};
SPRINGPROOF_FIELDS(Msm, design, has_auto_design, solver, poissons_ratio, split, beta, stiffness,
                   axis_stiffness, uniform_stiffness, volume_stiffness, network, law, exponent, paths,
                   weights, strain_range, has_volume_term, accepted, mass, iterations_per_step, where,
                   relaxation, real_time)

/// Gives a case that names no design the default of tetrahedra, hybrid, where its cells are such.
void settle_design(Msm& msm, bool is_tetrahedron);

/// The law of the springs: the case's, or the design's own: power-log springs where it finds their exponents.
/// The midline's are Hooke's in a material with a fibre and below nu = 0.25, where the volume term is
/// negative and springs that soften carry no large tension.
SpringLaw law_of(const Msm& msm, const Material& material);

/// Gives a design that may have either law Hooke's springs where its case asks for no law and the exponents
/// would not do: in a body of materials whose exponents differ, which would be springs of two laws, and under
/// forces on nodes above nu = 0.35, where springs that soften give way at an edge that is loaded.
/// @param materials  the body's
void settle_law(Msm& msm, const std::vector<Material>& materials, bool has_nodal_forces);

} // namespace springproof::cases
