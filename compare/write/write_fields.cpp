#include "compare/write/write.hpp"

#include "cases/case/input_file.hpp"
#include "cases/mesh/sharing.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "cases/scene/loads.hpp"
#include "compare/measure/measure.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/springs.hpp"
#include "compare/write/quote.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>

namespace springproof::compare {

namespace {

using Eigen::Vector3d;

std::vector<double> von_mises_of(const std::vector<cases::SymmetricTensor>& stress) {
  std::vector<double> values(stress.size());
  std::transform(stress.begin(), stress.end(), values.begin(), von_mises);
  return values;
}

/// @param cells  that the fields are of
void add_fields(cases::GridFields& all, const std::string& side, const cases::Mesh& mesh,
                const cases::Range& cells, const cases::Fields& fields) {
  all.point_vectors.push_back({side + "_reaction", fields.reaction, "N"});
  all.cell_tensors.push_back({side + "_strain", fields.strain, "1"});
  if (!fields.has_stress) return;
  all.cell_tensors.push_back({side + "_stress", fields.stress, "MPa"});
  all.cell_numbers.push_back({side + "_von_mises", von_mises_of(fields.stress), "MPa"});
  std::vector<double> density = fields.strain_energy;
  for (std::size_t c = 0; c < density.size(); ++c)
    density[c] /= cases::cell_volume(cases::cell_corners(mesh, cells.begin + c));
  all.cell_numbers.push_back({side + "_strain_energy_density", density, "N mm/mm3"});
}

void add_side(cases::GridFields& all, const std::string& side, const cases::Mesh& mesh,
              const cases::Solution& solution) {
  if (solution.status != cases::Status::converged) return;
  const cases::Sharing* const sharing = solution.sharing.get();
  all.point_vectors.push_back({side + "_displacement", solution.displacement, "mm"});
  if (mesh.cells.empty()) { // lines, which have no fields of cells
    if (solution.fields) all.point_vectors.push_back({side + "_reaction", solution.fields->reaction, "N"});
    return;
  }
  all.cell_numbers.push_back({side + "_cell_volume", solution.cell_volume, "mm3"});
  const std::vector<bool> inverted = cases::inverted_cells(mesh, solution.displacement, sharing);
  all.cell_numbers.push_back({side + "_inverted", {inverted.begin(), inverted.end()}, "1"});
  if (solution.fields) add_fields(all, side, mesh, cases::share_here(mesh, sharing).cells, *solution.fields);
}

/// What the springs are off the finite elements on the same mesh.
void add_errors(cases::GridFields& all, const cases::Mesh& mesh, const cases::Solution& fem,
                const cases::Solution& msm) {
  if (fem.status != cases::Status::converged || msm.status != cases::Status::converged) return;
  std::vector<Vector3d> difference = msm.displacement;
  std::vector<double> error;
  for (std::size_t n = 0; n < difference.size(); ++n) {
    difference[n] -= fem.displacement[n];
    error.push_back(difference[n].norm());
  }
  all.point_vectors.push_back({"difference", difference, "mm"});
  all.point_numbers.push_back({"error", error, "mm"});
  const double largest =
      field_norm(cases::measures::DisplacementFieldMax{}, mesh, fem.displacement, fem.sharing.get());
  if (largest > 0) {
    for (double& value : error) value /= largest;
    all.point_numbers.push_back({"relative_error", error, "1"});
  }
  const auto has_stress = [](const cases::Solution& side) { return side.fields && side.fields->has_stress; };
  if (!has_stress(fem) || !has_stress(msm)) return;
  std::vector<double> stress = von_mises_of(msm.fields->stress);
  const std::vector<double> reference = von_mises_of(fem.fields->stress);
  for (std::size_t c = 0; c < stress.size(); ++c) stress[c] -= reference[c];
  all.cell_numbers.push_back({"von_mises_difference", stress, "MPa"});
}

void add_case(cases::GridFields& all, const cases::Scene& scene, const cases::Share& here) {
  if (!scene.loads.empty() && !cases::has_load_histories(scene)) {
    std::vector<Vector3d> force(here.nodes.size(), Vector3d::Zero());
    for (const auto& [node, value] : cases::applied_forces(scene))
      if (here.nodes.has(cases::index(node))) force[cases::index(node) - here.nodes.begin] += value;
    all.point_vectors.push_back({"applied_force", force, "N"});
  }
  if (scene.mesh.cells.empty()) return;
  std::vector<double> material;
  for (std::size_t c = here.cells.begin; c < here.cells.end; ++c)
    material.push_back(cases::material_of(scene, c));
  all.cell_numbers.push_back({"material", material});
}

namespace fs = std::filesystem;

/// A share's cells as a mesh by itself; the fields' values of its nodes take the place of those of all that
/// are here.
cases::Mesh piece_of(const cases::Mesh& mesh, const cases::Share& share, cases::GridFields& fields) {
  std::vector<int> number(share.nodes.size(), -1); ///< in the piece, of each node that is here
  for (std::size_t c = share.cells.begin; c < share.cells.end; ++c)
    for (const int node : mesh.cells[c]) number[cases::index(node) - share.nodes.begin] = 0;
  cases::Mesh piece;
  piece.shape = mesh.shape;
  std::vector<Eigen::Vector3d>& nodes = piece.nodes.stored();
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] < 0) continue;
    number[n] = static_cast<int>(nodes.size());
    nodes.push_back(mesh.nodes[share.nodes.begin + n]);
    for (auto& field : fields.point_vectors) field.values[nodes.size() - 1] = field.values[n];
    for (auto& field : fields.point_numbers) field.values[nodes.size() - 1] = field.values[n];
  }
  for (auto& field : fields.point_vectors) field.values.resize(nodes.size());
  for (auto& field : fields.point_numbers) field.values.resize(nodes.size());
  std::vector<cases::CellNodes>& cells = piece.cells.stored();
  for (std::size_t c = share.cells.begin; c < share.cells.end; ++c) {
    cells.push_back(mesh.cells[c]);
    for (int& node : cells.back()) node = number[cases::index(node) - share.nodes.begin];
  }
  return piece;
}

/// Names of a case's files in a folder.
struct Files {
  std::string folder, name;
  std::string whole() const { return folder + "/" + name + ".vtu"; }
  std::string list() const { return folder + "/" + name + ".pvtu"; }
  std::string springs() const { return folder + "/" + name + "_springs.vtu"; }
  std::string pieces() const { return name + "_pieces"; }
  std::string piece(int rank) const { return fmt::format("{}/{}_{}.vtu", pieces(), name, rank); }
};

/// What ParaView opens: the names of the fields and of the pieces.
void write_list(std::ostream& out, const Files& files, const cases::GridFields& fields, std::size_t n_cells) {
  const auto array = [&](const std::string& name, int n_components) {
    out << fmt::format("      <PDataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n", name,
                       n_components);
  };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <PUnstructuredGrid GhostLevel=\"0\">\n"
         "    <PPointData>\n";
  for (const auto& field : fields.point_vectors) array(field.name, 3);
  for (const auto& field : fields.point_numbers) array(field.name, 1);
  out << "    </PPointData>\n    <PCellData>\n";
  for (const auto& field : fields.cell_numbers) array(field.name, 1);
  for (const auto& field : fields.cell_tensors) array(field.name, 6);
  out << "    </PCellData>\n    <PPoints>\n";
  array("rest position", 3);
  out << "    </PPoints>\n";
  for (int rank = 0; rank < n_mpi_ranks(); ++rank)
    if (cases::part_of(n_cells, rank, n_mpi_ranks()).size() > 0)
      out << fmt::format("    <Piece Source=\"{}\"/>\n", escape(files.piece(rank)));
  out << "  </PUnstructuredGrid>\n</VTKFile>\n";
}

/// @param displacement  one per node of all; empty: there are no springs to draw
void write_springs(const Files& files, const Comparison& comparison,
                   const std::vector<Eigen::Vector3d>& displacement) {
  std::error_code not_there;
  if (displacement.empty())
    fs::remove(files.springs(), not_there); // an earlier run's
  else
    write_file(files.springs(), [&](std::ostream& out) { write_springs_vtu(out, comparison, displacement); });
}

/// The springs' displacement of all nodes, for write_springs(). Collective, since the first rank alone may
/// know the design.
std::vector<Eigen::Vector3d> gathered_for_springs(const Comparison& comparison) {
  const cases::Solution& msm = comparison.answers.msm.solution;
  const bool are_drawn = !from_rank_0(has_drawn_springs(comparison) ? "yes" : "").empty();
  if (!are_drawn) return {};
  return msm.sharing ? msm.sharing->gather(msm.displacement) : msm.displacement;
}

void write_pieces(const Files& files, const Comparison& comparison, const cases::Share& share) {
  run_on_all_ranks([&] { // a list of what is about to change would lead to a mixture
    if (mpi_rank() != 0) return;
    std::error_code not_there;
    fs::remove(files.list(), not_there);
    fs::remove(files.whole(), not_there);
    claim_subfolder(files.folder, files.pieces());
  });
  cases::GridFields fields = grid_fields_of(comparison);
  const std::vector<Eigen::Vector3d> displacement = gathered_for_springs(comparison);
  run_on_all_ranks([&] {
    if (share.cells.size() == 0) return;
    const cases::Mesh piece = piece_of(comparison.scene.mesh, share, fields);
    write_file(files.folder + "/" + files.piece(mpi_rank()),
               [&](std::ostream& out) { out << cases::vtk().write_unstructured_grid(piece, fields); });
  });
  run_on_all_ranks([&] {
    if (mpi_rank() != 0) return;
    remove_numbered(files.folder + "/" + files.pieces(), files.name, n_mpi_ranks());
    write_springs(files, comparison, displacement);
    write_file(files.list(), [&](std::ostream& out) {
      write_list(out, files, fields, comparison.scene.mesh.cells.size());
    });
  });
}

using cases::index;
using Eigen::Vector3d;

/// Springs of a deformed body.
struct Lines {
  SpringLines at_rest;
  std::vector<double> stretch, tension;

  void add(int i, int j, double length, double the_tension, const msm::Spring& spring) {
    at_rest.add(i, j, spring);
    stretch.push_back(length / spring.rest_length);
    tension.push_back(the_tension);
  }
};

/// An edge of tetrahedra, which may share it.
struct Edge {
  double rest_length = 0, tension = 0, stiffness = 0;
};

std::string vtu_of(const cases::Mesh& mesh, const cases::GridFields& fields) {
  return mesh.cells.empty() ? cases::vtk().write_lines(mesh.nodes.to_vector(), mesh.lines, fields)
                            : cases::vtk().write_unstructured_grid(mesh, fields);
}

Lines lines_of(const msm::Lattice& lattice, const std::vector<Vector3d>& displacement) {
  const auto along = [&](int i, int j) -> Vector3d {
    return (lattice.rest[index(j)] - lattice.rest[index(i)]) +
           (displacement[index(j)] - displacement[index(i)]);
  };
  Lines lines;
  for (const auto& [i, j, spring] : lattice.links) {
    const double length = along(i, j).norm();
    lines.add(i, j, length, msm::spring_slopes(length, spring).transverse * length, spring);
  }
  std::map<std::pair<int, int>, Edge> edges;
  for (const msm::Tetrahedron& t : lattice.tetrahedra) {
    msm::TetrahedronPositions x;
    for (std::size_t v = 0; v < 4; ++v) x[v] = along(t.nodes[0], t.nodes[v]);
    const msm::EdgeValues tensions = t.tensions(x);
    for (std::size_t e = 0; e < 6; ++e) {
      const auto& [v, w] = msm::tetrahedron_edges[e];
      const int a = t.nodes[index(v)], b = t.nodes[index(w)];
      const auto at = Eigen::Index(e);
      Edge& edge = edges[std::minmax({a, b})];
      edge.rest_length = t.rest_lengths[at];
      edge.tension += tensions[at];
      edge.stiffness += 4 * t.stiffness(at, at) * edge.rest_length * edge.rest_length; // dT/d|d| at rest
    }
  }
  for (const auto& [ends, edge] : edges)
    lines.add(ends.first, ends.second, along(ends.first, ends.second).norm(), edge.tension,
              {edge.stiffness, edge.rest_length});
  return lines;
}

} // namespace

cases::GridFields grid_fields_of(const Comparison& comparison) {
  const cases::Scene& scene = comparison.scene;
  const cases::Solution &fem = comparison.answers.fem.solution, &msm = comparison.answers.msm.solution;
  cases::GridFields all;
  add_side(all, "fem", scene.mesh, fem);
  add_side(all, "msm", scene.mesh, msm);
  add_errors(all, scene.mesh, fem, msm);
  add_case(all, scene, cases::share_here(scene.mesh, sharing_of(comparison)));
  return all;
}

const cases::Sharing* sharing_of(const Comparison& comparison) {
  const Answers& answers = comparison.answers;
  const cases::Sharing* const of_fem = answers.fem.solution.sharing.get();
  return of_fem ? of_fem : answers.msm.solution.sharing.get();
}

void remove_numbered(const std::string& folder, const std::string& name, int first) {
  std::error_code ignored;
  if (fs::is_symlink(folder, ignored)) return;
  const std::string begin = name + "_";
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string stem = entry.path().stem().string();
    const auto number =
        cases::number_in<int>(std::string_view(stem).substr(std::min(stem.size(), begin.size())));
    if (entry.path().extension() == ".vtu" && stem.compare(0, begin.size(), begin) == 0 && number &&
        *number >= first)
      old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove(path, ignored);
  if (first == 0) fs::remove(folder, ignored); // if nothing else is in it
}

void write_vtu(std::ostream& out, const Comparison& comparison) {
  out << vtu_of(comparison.scene.mesh, grid_fields_of(comparison));
}

void write_vtu(std::ostream& out, const cases::Mesh& mesh, const std::vector<cases::PointField>& fields) {
  out << vtu_of(mesh, {fields});
}

void write_fields(const std::string& folder, const Comparison& comparison) {
  const Files files{folder, comparison.scene.definition.name};
  if (const cases::Sharing* sharing = sharing_of(comparison))
    return write_pieces(files, comparison, sharing->here());
  if (mpi_rank() != 0) return;
  std::error_code not_there;
  fs::remove(files.list(), not_there);
  remove_numbered(files.folder + "/" + files.pieces(), files.name, 0);
  const bool are_drawn = has_drawn_springs(comparison);
  write_springs(files, comparison,
                are_drawn ? comparison.answers.msm.solution.displacement : std::vector<Eigen::Vector3d>());
  write_file(files.whole(), [&](std::ostream& out) { write_vtu(out, comparison); });
}

std::string vtu_of_lines(const std::vector<Vector3d>& points, const SpringLines& lines,
                         cases::GridFields others) {
  others.cell_numbers.push_back({"stiffness", lines.stiffness, "N/mm"});
  others.cell_numbers.push_back({"rest_length", lines.rest_length, "mm"});
  return cases::vtk().write_lines(points, lines.ends, others);
}

bool has_drawn_springs(const Comparison& comparison) {
  const Answers& answers = comparison.answers;
  return answers.msm.converged() && answers.design && answers.msm_source.empty() &&
         comparison.scene.mesh.cells.size() <= most_cells_with_springs;
}

void write_springs_vtu(std::ostream& out, const Comparison& comparison,
                       const std::vector<Vector3d>& displacement) {
  const cases::Scene& scene = comparison.scene;
  const msm::Lattice lattice =
      msm::make_lattice(scene.mesh, springs_as_solved(scene, *comparison.answers.design));
  const Lines lines = lines_of(lattice, displacement);
  cases::GridFields all;
  all.point_vectors.push_back({"msm_displacement", displacement, "mm"});
  all.cell_numbers = {{"stretch", lines.stretch, "1"}, {"tension", lines.tension, "N"}};
  out << vtu_of_lines(lattice.rest, lines.at_rest, std::move(all));
}

} // namespace springproof::compare
