#pragma once

#include "cases/case/designs.hpp"
#include "cases/case/dynamics.hpp"
#include "cases/case/error.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

/// The shared vocabulary: what a case file says, as plain values. Units: mm, N, MPa, degrees.
namespace springproof::cases {

SPRINGPROOF_ENUMERATION(Axis, x, y, z)

struct Box {
  Eigen::Vector3d size;     ///< mm, > 0; the box reaches from the origin to size
  std::array<int, 3> cells; ///< > 0
};

/// An all-hexahedral gmsh mesh (.msh, format 4), or a .geo that gmsh meshes on the fly.
struct MeshFile {
  std::string path; ///< as opened: relative paths are resolved against the case file
  Where where;
  double scale = 1; ///< mm of a unit of the file
};

/// The cubes of a grid whose centres lie inside a closed surface (STL). The grid starts at the lower corner
/// of the surface's bounding box.
struct Voxels {
  std::string path; ///< as opened: relative paths are resolved against the case file
  double edge;      ///< mm, > 0
  Where where;
  double scale = 1; ///< mm of a unit of the file
};

/// A class of voxels, and of the cells that they fill.
struct LabelClass {
  std::string name;    ///< of no face, and another than the other classes'
  double lower, upper; ///< intensities, closed, lower <= upper
  bool is_rigid;       ///< bone: nodes of its cells are held unless something moves them; one class at most
};

/// Which of the pieces that share no face is the body.
SPRINGPROOF_ENUMERATION(Keep,
                        all,     ///< there is but one
                        largest, ///< the one of the most cells
                        seed     ///< the one with a point
)

/// The cells of a picture in three dimensions (NIfTI, NRRD, MetaImage, InVesalius) that are of some class.
struct Labels {
  std::string path;                                   ///< as opened, relative paths resolved
  double edge;                                        ///< mm, > 0, of a cell
  std::vector<LabelClass> classes;                    ///< 1 to 255; a voxel is of the first that has it
  std::optional<std::array<Eigen::Vector3d, 2>> crop; ///< mm: two corners, the lower one first
  Keep keep = Keep::all;
  Eigen::Vector3d seed = Eigen::Vector3d::Zero(); ///< mm
  Where where;
  double scale = 1; ///< on the lengths that the file says
};

using Body = std::variant<Box, MeshFile, Voxels, Labels>;

/// The class whose cells are rigid, if there is one.
inline const LabelClass* rigid_class(const Body& body) {
  const Labels* labels = std::get_if<Labels>(&body);
  if (labels == nullptr) return nullptr;
  const auto found = std::find_if(labels->classes.begin(), labels->classes.end(),
                                  [](const LabelClass& one) { return one.is_rigid; });
  return found == labels->classes.end() ? nullptr : &*found;
}

struct LinearElastic {
  double youngs_modulus; ///< MPa, > 0
  double poissons_ratio; ///< in (-1, 0.5)
};

/// W = sum_i 2 mu_i/alpha_i² (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3) of the isochoric stretches
/// + kappa/4 (J² - 1 - 2 ln J). Neo-Hookean: alpha = 2; Mooney-Rivlin: alpha = 2, -2.
struct Ogden {
  std::vector<double> mu;             ///< MPa; the sum is the initial shear modulus, > 0
  std::vector<double> alpha;          ///< as many, none 0
  std::optional<double> bulk_modulus; ///< MPa; absent: nearly incompressible
};

/// Linear elastic with an axis of symmetry, its fibre: engineering constants along and across it. The strain
/// energy is positive when poissons_ratio_along² < (1 - poissons_ratio_across) E_along/(2 E_across).
struct TransverselyIsotropic {
  double youngs_modulus_along, youngs_modulus_across; ///< E_L, E_T, MPa, > 0
  double poissons_ratio_along;  ///< nu_LT: contraction across the fibre, pulled along it
  double poissons_ratio_across; ///< nu_TT in (-1, 1): contraction across the fibre, pulled across it
  double shear_modulus_along;   ///< G_LT, MPa, > 0: between the fibre and a direction across it
  Eigen::Vector3d fibre;        ///< unit length
};

using Material = std::variant<LinearElastic, Ogden, TransverselyIsotropic>;

/// The axis along which a direction lies, to 1e-9 of its length; none when it lies askew.
inline std::optional<Axis> axis_along(const Eigen::Vector3d& direction) {
  int axis = 0;
  const double along = direction.cwiseAbs().maxCoeff(&axis);
  Eigen::Vector3d across = direction;
  across[axis] = 0;
  if (across.norm() > 1e-9 * along) return std::nullopt;
  return static_cast<Axis>(axis);
}

inline bool is_isotropic(const Material& material) {
  return !std::holds_alternative<TransverselyIsotropic>(material);
}

/// A material of a part of the body, in place of the body's own: of the cells of a physical group, or of
/// those whose centre lies in a box.
struct RegionMaterial {
  Material material;            ///< of the same model as the body's own
  std::string group;            ///< empty: the box
  Eigen::Vector3d lower, upper; ///< mm; infinite where the box has no end
  Where where;
  MaterialDynamics dynamics{};
};

/// The nodes of a body, or of the cells of one class of it, that lie in a box and on or beyond a plane.
struct Part {
  std::string cell_class;                           ///< a three-dimensional group's name; empty: every cell
  Eigen::Vector3d lower, upper;                     ///< mm; infinite where the box has no end
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< mm; of the plane
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); ///< unit length, towards the part; zero: no plane
};

/// Part of a body: "z+ x-" on a box, the name of a physical group on a mesh, the node nearest to a point, a
/// patch of the surface around a point, or the nodes of a class, in a box or beyond a plane.
struct Region {
  std::string name;                    ///< as written; of a patch or part for messages; empty for a node
  std::optional<Eigen::Vector3d> near; ///< mm
  Where where;
  std::optional<double> radius{}; ///< mm, > 0: the boundary faces whose centre is at most that far from near
  std::optional<Part> part{};
};

struct Fixed {
  Region region;
  std::array<bool, 3> components{true, true, true};
};

/// Where a motion fades out (thesis section 6.1.3, the scaled displacement method): its factor is 0 on and
/// behind a plane, 1 from `length` beyond it on, and linear between, the zone that is scaled.
struct ScaledDisplacement {
  Eigen::Vector3d point;  ///< mm; of the plane
  Eigen::Vector3d normal; ///< unit length, towards the part that moves as a whole
  double length;          ///< mm, > 0
  Where where;

  /// In [0, 1], of a place in the body at rest (mm).
  double factor(const Eigen::Vector3d& rest) const {
    return std::clamp((rest - point).dot(normal) / length, 0.0, 1.0);
  }
};

/// A piece that is cut out of the body: the cells whose centre lies in a box. Where its two sides along an
/// axis are joined (thesis section 6.1.3, the removing method), the upper one ends on the lower one.
struct Removed {
  Eigen::Vector3d lower, upper; ///< mm
  std::optional<Axis> join;     ///< absent: the cut stays open
  Where where;
};

/// A region of prescribed motion: at load factor s, s times a displacement or a rotation by s times an angle;
/// in a dynamic case s is its history.
struct Moved {
  Region region;
  std::array<bool, 3> components{true, true, true};       ///< all three when it is turned
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero(); ///< mm at full load, on its components
  double angle = 0;                                       ///< degrees at full load, about axis through centre
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();        ///< unit length
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();       ///< mm
  History history{};
  std::optional<ScaledDisplacement> scaled{}; ///< absent: the region moves as a whole
  int steps = 1;                              ///< of the load, at least
};

SPRINGPROOF_ENUMERATION(
    LoadKind,
    nodal_force, ///< value N on every node of the region
    total_force, ///< value N, shared equally by the region's nodes
    traction,    ///< value MPa on the rest area, dead, integrated consistently
    torque, ///< moment N mm about axis through centre; tangential traction growing linearly with the radius
    gravity ///< value m/s² on all that has mass; without a region
)

inline bool acts_on_area(LoadKind kind) {
  return kind == LoadKind::traction || kind == LoadKind::torque;
}

struct Load {
  Region region;
  LoadKind kind;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< N, MPa or m/s²; unused by torque
  double moment = 0;                                ///< N mm; torque only
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< torque only, unit length
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(); ///< mm; torque only
  History history{};
};

/// A mass that moves with a region, without stiffness of its own.
struct AddedMass {
  Region region;
  double mass; ///< kg, > 0, shared equally by the region's nodes
};

SPRINGPROOF_ENUMERATION(Formulation, small_strain, saint_venant_kirchhoff, log_strain, hyperelastic)
SPRINGPROOF_ENUMERATION(Element, q1, q1_bbar, q1_p0, q2, q2_p1)

/// What a side that converged must not be, unless its case accepts it.
SPRINGPROOF_ENUMERATION(Doubt,
                        inverted, ///< has cells with a corner Jacobian <= 0
                        unstable  ///< its tangent has negative eigenvalues
)

struct Fem {
  Formulation formulation = Formulation::log_strain;
  Element element = Element::q1_bbar;
  int refine = 0;                    ///< uniform refinements of the body's mesh, FEM side only
  bool has_auto_formulation = false; ///< small_strain where the strains allow it, else the formulation above
  bool has_auto_accuracy = false;    ///< further meshes until the limit is known well enough
  std::vector<Doubt> accepted;       ///< not held against the side
  ElementMass mass = ElementMass::consistent;
  Where where;
};

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

/// How a spring's tension follows its stretch q.
SPRINGPROOF_ENUMERATION(SpringLaw,
                        hooke,    ///< k l0 (q - 1), and a volume term of pressure k_v (J - 1)
                        power_log ///< k l0 q^p ln q, and k_v ln J
)

/// The springs of design = "network", CSV: cases/scene/network.hpp.
struct NetworkFile {
  std::string path; ///< as opened: relative paths are resolved against the case file
  Where where;
};

/// How often force scaling moves the points, whether that is enough or not: some steps of the load, and
/// further iterations at full load.
struct RelaxationCounts {
  int load_steps = 1;
  int per_step = 0; ///< iterations after every load step
  int further = 0;  ///< iterations after the last one's
  long all() const { return static_cast<long>(load_steps) * per_step + further; }
};

struct Msm {
  Design design = Design::linear_method;
  Solver solver = Solver::newton;
  std::optional<double> poissons_ratio; ///< design from another nu than the material's
  std::optional<double> split;          ///< t of the moduli, hybrid, matched and multi_load designs, 0 to 1
  std::optional<std::array<double, 3>> stiffness; ///< N/m: k_e, k_f, k_d; design = "given"
  /// N/m: k_e along x, y, z; k_f in the faces across x, y, z; k_d; design = "given", in place of stiffness
  std::optional<std::array<double, 7>> axis_stiffness;
  std::optional<double> uniform_stiffness; ///< N/m, of every spring; design = "uniform"
  double volume_stiffness = 0;             ///< MPa: k_v; design = "given"
  std::optional<NetworkFile> network;      ///< design = "network"
  SpringLaw law = SpringLaw::hooke;
  std::optional<std::array<double, 3>> exponent; ///< p of edges, face and internal diagonals; power_log. The
                                                 ///< matched design finds its own where there is none
  std::vector<LoadPath> paths;                   ///< multi_load; empty: all
  std::vector<double> weights;                   ///< multi_load; one per path, >= 0; empty: all 1
  std::optional<std::array<double, 2>> strain_range; ///< matched, multi_load, nonlinear_method: logarithmic
  bool has_volume_term = true;                       ///< multi_load: springs and k_v, or springs alone
  std::vector<Doubt> accepted;                       ///< not held against the side
  PointMass mass = PointMass::cells;
  std::optional<int> iterations_per_step; ///< in time: of conjugate gradients, as a simulator's step has them
  Where where;
  std::optional<RelaxationCounts> relaxation{}; ///< force_scaling; absent: until it is in equilibrium
};

SPRINGPROOF_ENUMERATION(MeasureKind, coordinate, displacement, tilt, twist, volume, displacement_field_l2,
                        displacement_field_max, reaction, strain_energy, stress, strain, curvature)

/// Of a quantity's values on several cells.
SPRINGPROOF_ENUMERATION(Statistic, largest, mean,
                        deviation ///< root of the mean square distance from the mean
)

/// Whether a measure is one of Solution::fields, which a displacement alone does not tell.
constexpr bool is_of_fields(MeasureKind kind) {
  return kind == MeasureKind::reaction || kind == MeasureKind::strain_energy || kind == MeasureKind::stress ||
         kind == MeasureKind::strain;
}
SPRINGPROOF_ENUMERATION(Component, x, y, z, norm)
/// Of a symmetric tensor. principal_1 is its largest eigenvalue, principal_3 its smallest.
SPRINGPROOF_ENUMERATION(TensorComponent, xx, yy, zz, xy, yz, xz, von_mises, principal_1, principal_2,
                        principal_3)

struct Measure {
  std::string name;
  MeasureKind kind;
  Region node;         ///< coordinate, displacement, twist: exactly one node
  Axis axis = Axis::z; ///< coordinate; twist: the axis looked along (thesis: beta is seen along z)
  Component component = Component::norm; ///< displacement, reaction
  Region top, bottom;                    ///< tilt: one node each
  Axis toward = Axis::x; ///< tilt: atan2(d_toward, d_up) of top - bottom, up = axis (default z)
  Region centre;         ///< twist
  Region region;         ///< reaction: of supports
  Eigen::Vector3d point = Eigen::Vector3d::Zero();        ///< stress, strain: mm, of the body at rest
  TensorComponent tensor_component = TensorComponent::xx; ///< stress, strain
  Where point_where;
  Where where;
  std::optional<OverTime> over_time{}; ///< of a dynamic case's measures, but for norms of fields
  /// stress, strain: of the cells with a face in the region, in place of the point's; where the region has no
  /// name, of all cells
  std::optional<Statistic> statistic{};
};

/// The surface that divides the intensities of a picture.
struct PictureContour {
  double intensity;
  int n_smoothing;            ///< passes of a filter; 0: none
  std::size_t most_triangles; ///< about so many at most; 0: all
};

/// A surface that the body takes along: of a skin, say, which the cells follow in steps. Triangles of a file
/// (STL, VTP), or the contour of the picture that the body is made of.
struct BodySurface {
  std::string path; ///< of the file or the picture, as opened: relative paths are resolved
  std::optional<PictureContour> contour;
  Where where;
  double scale = 1; ///< mm of a unit of the file
};

/// A place of the body's surface at which the surfaces of both models are compared.
struct Landmark {
  std::string name;
  Eigen::Vector3d point; ///< mm, of the body at rest, on its surface or near it
};

/// Where an expectation's interval comes from; reports count the kinds separately.
SPRINGPROOF_ENUMERATION(ReferenceKind, exact, converged, peer, published, regression)
SPRINGPROOF_ENUMERATION(Quantity, error_percent, msm, fem)

struct Expectation {
  std::string measure;
  Quantity quantity;
  std::array<double, 2> interval; ///< closed, lower <= upper; percent or the measure's unit
  ReferenceKind reference;
  std::string reason;
  Where where;
  std::array<Where, 2> ends_where = {}; ///< of the interval's ends
};

/// The two models that are compared.
SPRINGPROOF_ENUMERATION(Side, fem, msm)

/// Where the springs' search for equilibrium begins.
SPRINGPROOF_ENUMERATION(
    Start, rest,
    perturbed, ///< every point moved by up to an amplitude in each component
    inverted   ///< the body mirrored at its lowest plane of z: every cell inside out, held points excepted
)

/// What must become of one model of a hard case.
struct ExpectedOutcome {
  std::string model; ///< name of its table
  Side side;
  std::optional<Design> design; ///< of the springs, in place of the case's own with all its settings
  Outcome outcome;
  std::optional<std::array<double, 2>> load_reached; ///< closed, of the full load
  std::optional<int> inverted_cells;
};

/// The part of a body beyond a plane, whose springs are stiffer by a factor.
struct Stiffer {
  Axis axis;
  double beyond; ///< mm: cells whose centre lies beyond
  double factor; ///< > 0
};

/// What makes a case hard: [stress]. Given stiffnesses, of any sign, stand in [msm].
struct Stress {
  bool is_heavy = false; ///< takes minutes: run when asked for
  Start start = Start::rest;
  double amplitude = 0;                  ///< mm; perturbed
  int seed = 0;                          ///< perturbed
  std::optional<Stiffer> stiffer;        ///< springs only
  int least_load_steps = 1;              ///< of equal size or smaller
  double max_seconds = 0;                ///< of each solve
  int max_iterations = 0;                ///< of Newton's method, of each solve
  std::vector<ExpectedOutcome> expected; ///< one per model that is solved, at least one
};

struct Case {
  std::string name;
  std::string description;
  std::string file;
  Body body;
  Material material;
  MaterialDynamics material_dynamics;
  std::vector<RegionMaterial> region_materials; ///< a cell in several of them is of the last one
  std::vector<Fixed> fixed;
  std::vector<Fixed> symmetry; ///< region = a face of a box, components = its normal alone
  std::vector<Moved> moved;
  std::vector<Load> loads; ///< may be empty when something is moved
  std::vector<AddedMass> masses;
  Fem fem;
  Msm msm;
  std::vector<Measure> measures;
  std::vector<Expectation> expectations;
  std::optional<Stress> stress; ///< of a hard case
  bool has_fields = false;      ///< solutions get their fields: a measure or a file of results needs them
  std::optional<Dynamics> dynamics;
  std::optional<BodySurface> surface{}; ///< absent: the outer one of the cells
  std::vector<Landmark> landmarks{};
  std::vector<Removed> removed{}; ///< of the body
};

/// Degrees. Small strains know where a turned region ends, and nothing of the way: what turns further ends
/// where a smaller turn the other way does.
constexpr double largest_turn_of_small_strain = 180;

/// The largest angle that a region is turned by, degrees, >= 0.
inline double largest_turn(const Case& definition) {
  double largest = 0;
  for (const Moved& moved : definition.moved) largest = std::max(largest, std::abs(moved.angle));
  return largest;
}

/// Load steps that the motions ask for.
inline int least_load_steps(const Case& definition) {
  int steps = 1;
  for (const Moved& moved : definition.moved) steps = std::max(steps, moved.steps);
  return steps;
}

} // namespace springproof::cases
