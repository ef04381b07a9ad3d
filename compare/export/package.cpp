#include "compare/export/package.hpp"

#include "cases/case/installation.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <random>

namespace springproof::compare {

namespace {

using cases::index;
using Eigen::Vector3d;

/// Moves every node by up to this part of the body's shortest spring in each direction.
msm::Points any_displacement(const msm::Lattice& lattice, double part) {
  double shortest = 1e300;
  for (const msm::Link& link : lattice.links) shortest = std::min(shortest, link.spring.rest_length);
  for (const msm::Tetrahedron& one : lattice.tetrahedra)
    shortest = std::min(shortest, one.rest_lengths.minCoeff());
  std::mt19937 generator(1); // the same of every implementation
  const auto any = [&] { return part * shortest * (2 * (double(generator()) / 4294967295.0) - 1); };
  msm::Points displacement(lattice.rest.size());
  for (Vector3d& u : displacement)
    for (double& component : u) component = any();
  return displacement;
}

bool are_finite(const msm::Points& points) {
  return std::all_of(points.begin(), points.end(), [](const Vector3d& p) { return p.allFinite(); });
}

} // namespace

std::size_t n_other_terms(const msm::Lattice& lattice) {
  const auto n_of_law = std::count_if(lattice.links.begin(), lattice.links.end(), [](const msm::Link& link) {
    return link.spring.law.kind != msm::LawKind::hooke;
  });
  return lattice.volume_cells.size() + lattice.volume_patches.size() + lattice.tetrahedra.size() +
         lattice.midlines.size() + std::size_t(n_of_law);
}

void write_volume_tetrahedra_csv(const std::string& folder, const msm::Lattice& lattice) {
  constexpr std::array<std::array<int, 4>, 2> inscribed{{{0, 3, 5, 6}, {1, 2, 7, 4}}};
  write_csv_file(folder + "/volume_tetrahedra.csv", [&](CsvWriter& csv) {
    csv.row("stiffness_MPa", "rest_volume_mm3", "law", "node_0", "node_1", "node_2", "node_3");
    for (const msm::VolumeCell& cell : lattice.volume_cells)
      for (const auto& vertices : inscribed) {
        auto nodes = cases::pick(cell.nodes, vertices);
        double volume = msm::volume_of(msm::at_nodes(nodes, lattice.rest));
        if (volume < 0) std::swap(nodes[2], nodes[3]), volume = -volume;
        csv.row(fmt::format("{}", cell.stiffness * cell.rest_volume / (2 * volume)),
                fmt::format("{}", volume), cell.is_logarithmic ? "logarithmic" : "linear", nodes[0], nodes[1],
                nodes[2], nodes[3]);
      }
  });
}

NumberArray skin_weights(const mechanics::EmbeddedSurface& skin) {
  NumberArray rows{3};
  for (std::size_t v = 0; v < skin.vertices.size(); ++v) {
    const mechanics::EmbeddedPoint& point = skin.vertices[v];
    for (std::size_t i = 0; i < point.nodes.size(); ++i)
      if (point.weights[i] != 0) rows.add({double(v), double(point.nodes[i]), point.weights[i]});
  }
  return rows;
}

std::string write_skin_csv(const std::string& folder, const mechanics::EmbeddedSurface& skin) {
  write_csv_file(folder + "/skin_weights.csv", [&](CsvWriter& csv) {
    csv.row("vertex", "node", "weight");
    const NumberArray rows = skin_weights(skin);
    for (std::size_t i = 0; i < rows.values.size(); i += 3)
      csv.row(int(rows.values[i]), int(rows.values[i + 1]), fmt::format("{}", rows.values[i + 2]));
  });
  write_csv_file(folder + "/skin_triangles.csv", [&](CsvWriter& csv) {
    csv.row("vertex_0", "vertex_1", "vertex_2");
    for (const auto& [a, b, c] : skin.rest.triangles) csv.row(a, b, c);
  });
  return fmt::format(
      "skin_weights.csv, skin_triangles.csv: a surface of {} vertices that the nodes take along",
      skin.vertices.size());
}

void copy_program(const std::string& folder, const std::string& data, const std::string& name,
                  const std::string& as) {
  const std::string program = read_file(cases::data_folder(data) + "/" + name);
  write_file(folder + "/" + as, [&](std::ostream& out) { out << program; });
}

std::string write_references(const std::string& folder, const msm::Lattice& lattice, double force) {
  copy_program(folder, "clients", "reference/forces.py", "forces.py");
  double part = 0.05; // less where cells are so flat that they would be turned inside out
  msm::Points displacement = any_displacement(lattice, part), forces;
  while (!are_finite(forces = msm::internal_force_at(lattice, displacement)))
    displacement = any_displacement(lattice, part /= 2);
  write_csv_file(folder + "/check.csv", [&](CsvWriter& csv) {
    std::vector<std::string> header{"node", "displacement_x_mm", "displacement_y_mm", "displacement_z_mm"};
    for (const char axis : {'x', 'y', 'z'})
      header.push_back(fmt::format("force_{}_{}", axis, force == 1 ? "N" : "mN"));
    csv.row(header);
    for (std::size_t n = 0; n < forces.size(); ++n) {
      std::vector<std::string> row{std::to_string(n)};
      for (const double u : displacement[n]) row.push_back(fmt::format("{}", u));
      for (const double f : forces[n]) row.push_back(fmt::format("{}", force * f));
      csv.row(row);
    }
  });
  return "forces.py, check.csv: the forces in NumPy, and a deformed state with its forces to prove a program "
         "of your own by";
}

} // namespace springproof::compare
