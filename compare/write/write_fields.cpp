#include "compare/write/write_fields.hpp"

#include "cases/case/rows.hpp"
#include "cases/mesh/sharing.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/write/escape.hpp"
#include "compare/write/grid_fields.hpp"
#include "compare/write/write_springs.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

namespace fs = std::filesystem;

/// A share's cells as a mesh by itself; the fields' values of its nodes take the place of those of all that
/// are here.
cases::HexMesh piece_of(const cases::HexMesh& mesh, const cases::Share& share, cases::GridFields& fields) {
  std::vector<int> number(share.nodes.size(), -1); ///< in the piece, of each node that is here
  for (std::size_t c = share.cells.begin; c < share.cells.end; ++c)
    for (const int node : mesh.cells[c]) number[cases::index(node) - share.nodes.begin] = 0;
  cases::HexMesh piece;
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
  std::vector<std::array<int, 8>>& cells = piece.cells.stored();
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

/// @param displacement  of all nodes; empty: there are no springs to draw
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
    const cases::HexMesh piece = piece_of(comparison.scene.mesh, share, fields);
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

} // namespace

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
  out << cases::vtk().write_unstructured_grid(comparison.scene.mesh, grid_fields_of(comparison));
}

void write_vtu(std::ostream& out, const cases::HexMesh& mesh, const std::vector<cases::PointField>& fields) {
  out << cases::vtk().write_unstructured_grid(mesh, {fields});
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

} // namespace springproof::compare
