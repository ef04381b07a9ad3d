#pragma once

#include "cases/mesh/vtk_functions.hpp"
#include "cases/scene/scene.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/table/json.hpp"
#include "msm/design/design.hpp"
#include "msm/spring.hpp"

#include <ostream>
#include <string>
#include <vector>

/// One plain record (Comparison), many writers: text in lines of at most 100 columns, JSON, CSV and files. Of
/// gates, kinds of references are kept apart in each.
namespace springproof::compare {

/// What a run's text has of the mesh study.
enum class MeshTable { left_out, printed };

/// Body, loads, both sides, warnings, the peer, measures and expectations, in lines of at most 100 columns.
/// The verdict comes after it: write_verdict_text() of compare/study.
void write_text(std::ostream& out, const Comparison& comparison, MeshTable meshes = MeshTable::left_out);

/// Whether a measure's error is the norm of a difference, of fields over the body or of courses over time; it
/// has no sign.
bool is_norm(const MeasuredValue& measured, const cases::Case& definition);

/// The body's size, so that one in metres is told from one in millimetres; the loads as one force and one
/// moment, unless a load follows a history; the areas that loads and motions act on.
void write_scene_text(std::ostream& out, const cases::Scene& scene);

/// {"size_mm", "volume_mm3", "cells", "nodes"}
Json body_to_json(const cases::Scene& scene);

/// {"force_N", "moment_N_mm", "about_mm" (null where a load follows a history), "areas_mm2": {"load[0]":
/// ...}}
Json loads_to_json(const cases::Scene& scene);

/// A cell's stiffnesses: "k_e, k_f, k_d = 31, 47, 33 N/m, k_v = 0.02 MPa", and exponents if there are any.
std::string stiffness_text(const msm::CellStiffness& k);

/// A design's springs in a few words: "k_e, k_f, k_d = 31, 47, 33 N/m", "12 springs of 50, 6 of 50 N/m in a
/// cell", "5 tetrahedra in a cell".
std::string springs_text(const msm::DesignResult& design);

/// stiffness_N_per_m (null where the cells are not of four stiffnesses), volume_stiffness_MPa, exponents if
/// there are any, and `cell`, the springs of a cell one by one, where there are no four stiffnesses.
Json springs_to_json(const msm::DesignResult& design);

/// Everything that the program warns of in a case's result, a sentence each: about the loads, the files that
/// the body is made from, another program's displacements, and the design of the springs. Warnings about
/// steps in time are in notes_on_motion().
std::vector<std::string> warnings_of(const Comparison& comparison);

/// A measure's values on all meshes, its limit where there is one, and why there is none.
Json studied_to_json(const StudiedMeasure& measure);

void write_landmarks_text(std::ostream& out, const Comparison& comparison);

/// [{"name", "point", "from_point", "n_rays", "mean", "deviation", "moved", "reason"}], lengths in mm.
Json landmarks_to_json(const Comparison& comparison);

/// One row per landmark: case,landmark,x,y,z,from_point,n_rays,mean,deviation,moved; lengths in mm.
void write_landmarks_csv(std::ostream& out, const Comparison& comparison);

/// One row per measure and step: case,measure,unit,time,fem,msm; times in s, empty where a model has no
/// motion.
void write_motion_csv(std::ostream& out, const Comparison& comparison);

/// {"time", "fem", "msm", "difference", "largest_difference", "error_percent"}
Json surface_to_json(const SurfaceMotion& surface);

/// The same as write_motion_csv(), and the notes: {"notes": [...], "time": [...], "measures": [{"name",
/// "unit", "fem": [...], "msm": [...]}]}, and of a case with a [surface] how far the models' are apart:
/// "surface", as surface_to_json() has it; null for a case without motion.
Json motion_to_json(const Comparison& comparison);

/// What steps make of each model's slowest vibration: of the implicit Euler method always, of another scheme
/// where they change it; what the implicit Euler method adds to the damping of every measure that swings;
/// warnings where that is more than the body's own; and a line on how far the surfaces of both models are
/// apart.
std::vector<std::string> notes_on_motion(const Comparison& comparison);

/// FOLDER/NAME_motion.csv, and FOLDER/NAME.pvd, which lists the bodies FOLDER/NAME_motion/NAME_0000.vtu, ...
/// by their times; of a case without motion nothing. On one rank.
/// @throws InputError if a file cannot be written
void write_motion(const std::string& folder, const Comparison& comparison);

/// What every document of results begins with: schema, program and machine.
Json provenance();

/// "converged", "failed" or "skipped"; of an answer that was asked for after a number of iterations, and that
/// is no equilibrium, that.
std::string status_of(const cases::Solution& solution);

/// The solution of one side and what it took.
Json side_to_json(const Answer& answer);

/// One of the cases of to_json().
Json case_to_json(const Comparison& comparison);

/// The document of `run --json`: schema, program, machine and the cases.
Json to_json(const std::vector<Comparison>& comparisons);

/// One row per case and measure: case,measure,unit,fem,msm,error_percent,fem_status,msm_status,
/// fem_discretisation_error_percent,peer,reference,fem_limit,fem_limit_uncertainty,error_uncertainty_percent,
/// error_same_mesh_percent; empty where there is no value.
void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons);

/// The files of `--out`: results.json and comparison.csv of all cases, and fields and motion of the last one.
/// Called after every case, so that what is finished is on disk before the next begins; by every rank.
/// @param done  at least one
void write_results(const std::string& folder, const std::vector<Comparison>& done);

/// Why a gate is not met; empty when it is.
std::string reason_of(const Gate& gate);

/// A gate in words: "alpha_1 error_percent = -4.98 % in [-6.44, -3.38]", or with the reason why not.
std::string describe(const Gate& gate);

/// What `run` tells of a case's expectations: how many are met, and of the others a line each, "MISSED", or
/// "not judged" of those that need a side that was not asked for.
void write_expectations_text(std::ostream& out, const std::vector<Gate>& gates);

/// The same: [{"measure", "quantity", "interval", "reference", "value", "met", "judged", "undecided",
/// "reason"}, ...]
Json expectations_to_json(const std::vector<Gate>& gates);

/// One line per gate (and per failure of a case as a whole), warnings under their gates, and counts per kind.
void write_gates_text(std::ostream& out, const std::vector<Comparison>& cases);

/// JUnit's XML as continuous-integration servers read it: a test suite per kind of reference, named
/// springproof.KIND, a test case per gate; a gate without a value is an error, one outside its interval a
/// failure. What failed as a whole stands in the suite springproof.cases. Without times, so that the same
/// results make the same file.
void write_gates_junit(std::ostream& out, const std::vector<Comparison>& cases);

/// {"schema", "program", "machine", "gates": [...], "failures": [...], "kinds": {...}, "met"}
Json gates_to_json(const std::vector<Comparison>& cases);

/// GitHub's workflow commands: "::error file=...,line=...,title=...::message" for what is not met,
/// "::warning" for warnings.
void write_gates_annotations(std::ostream& out, const std::vector<Comparison>& cases);

/// Both models on the body's mesh at rest, so that "warp by vector" overlays them. Each side that
/// converged has, as `fem_` and `msm_`:
///   at nodes  displacement (mm), reaction (N);
///   in cells  cell_volume (mm³), inverted (0 or 1), stress (Cauchy, MPa), von_mises (MPa), strain
///             (logarithmic), strain_energy_density (N mm per mm³ at rest).
/// Both give difference (vector, springs less finite elements, mm), error (its length, mm), relative_error
/// (over the finite elements' largest displacement) and von_mises_difference (MPa), the case gives
/// applied_force (N, at nodes, full load; not where a load follows a history), material (number of the cell's
/// [[region_material]], 0: the body's own). Stress, strain and reactions are there when the solutions have
/// fields, stress and energy when their springs belong to cells.
///
/// Ranks that share the answers have the nodes and cells that are here; the names are the same on every rank.
/// Collective.
cases::GridFields grid_fields_of(const Comparison& comparison);

/// The ranks that share a comparison's answers; null: all of them is here.
const cases::Sharing* sharing_of(const Comparison& comparison);

/// The body's mesh at rest with grid_fields_of() the comparison as a VTK unstructured grid (.vtu, doubles,
/// raw binary), for ParaView. Every array carries its unit as VTK's UNITS_LABEL; tensors have the components
/// XX, YY, ZZ, XY, YZ, XZ. All of the answers is here: no ranks share them.
void write_vtu(std::ostream& out, const Comparison& comparison);

/// Any vectors on a mesh's nodes as a .vtu.
void write_vtu(std::ostream& out, const cases::Mesh& mesh, const std::vector<cases::PointField>& fields);

/// Removes FOLDER/NAME_NUMBER.vtu of this number and above, of an earlier run, and the folder if nothing is
/// left.
void remove_numbered(const std::string& folder, const std::string& name, int first);

/// The same as files: FOLDER/NAME.vtu or, where ranks share the answers, FOLDER/NAME_pieces/NAME_RANK.vtu and
/// FOLDER/NAME.pvtu, which is written when its pieces are whole; and FOLDER/NAME_springs.vtu, the springs as
/// lines, where has_drawn_springs(). What other numbers of ranks have left is removed. Every rank calls it.
/// @throws InputError if a file cannot be written
void write_fields(const std::string& folder, const Comparison& comparison);

/// Springs as lines between points.
struct SpringLines {
  std::vector<std::array<int, 2>> ends;
  std::vector<double> stiffness;   ///< at rest, N/mm
  std::vector<double> rest_length; ///< mm

  void add(int i, int j, const msm::Spring& spring) {
    ends.push_back({i, j});
    stiffness.push_back(spring.stiffness);
    rest_length.push_back(spring.rest_length);
  }
};

/// The lines as a VTK unstructured grid (.vtu, doubles, raw binary), with their stiffness and rest_length.
/// @param points  at rest, mm    @param others  further fields of the points and the lines
std::string vtu_of_lines(const std::vector<Eigen::Vector3d>& points, const SpringLines& lines,
                         cases::GridFields others);

/// Cells of a body up to which its springs are drawn: 2 million lines, 150 MB.
constexpr std::size_t most_cells_with_springs = 150000;

/// Whether the springs' side converged with springs of ours, and the body is not too large.
bool has_drawn_springs(const Comparison& comparison);

/// Springs as lines of a VTK unstructured grid (.vtu, doubles, raw binary): stretch (deformed over rest
/// length), tension (N, below 0 when pressed), stiffness at rest (N/mm), rest_length (mm), and at points
/// msm_displacement (mm). Springs of one law that cells share are one line; so are edges that biquadratic
/// tetrahedra share, whose tension also follows the other edges of the tetrahedron.
/// @param comparison    one for which has_drawn_springs() holds
/// @param displacement  displacement of the springs, mm, on all nodes, whoever shares them
void write_springs_vtu(std::ostream& out, const Comparison& comparison,
                       const std::vector<Eigen::Vector3d>& displacement);

} // namespace springproof::compare
