#include "compare/export/export_springs.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "compare/export/package.hpp"
#include "compare/measure/surfaces.hpp"
#include "compare/solve/springs.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

using cases::index;
using Eigen::Vector3d;

/// Returns the fewest digits that bring the number back.
std::string exact(double number) {
  return fmt::format("{}", number);
}

template<class Numbers>
std::vector<std::string> exact(const Numbers& numbers) {
  std::vector<std::string> texts;
  for (const auto number : numbers) texts.push_back(fmt::format("{}", number));
  return texts;
}

#pragma GCC diagnostic error "-Wswitch" // a law that the files cannot tell must not compile
/// The exponent of a power-log spring, nothing of a spring of Hooke's.
std::optional<double> exponent_of(const msm::Spring& spring) {
  switch (spring.law.kind) {
  case msm::LawKind::hooke:
    return std::nullopt;
  case msm::LawKind::power_log:
    break;
  }
  return spring.law.parameter;
}

/// Finds every link's kind among the springs of the mesh's cells: 1 an edge, 2 a face diagonal, 3 an internal
/// diagonal; 0 for a link of a network that is none of these.
std::vector<int> kinds_of_links(const cases::Mesh& mesh, const std::vector<msm::Link>& links) {
  struct Pair {
    int i, j, kind;
    bool operator<(const Pair& other) const { return std::tie(i, j) < std::tie(other.i, other.j); }
  };
  std::vector<Pair> pairs;
  const auto add = [&](const cases::CellNodes& cell, const auto& of_kind, int kind) {
    for (const auto& vertices : of_kind) {
      const auto [i, j] = cases::sorted(cases::pick(cell, vertices));
      pairs.push_back({i, j, kind});
    }
  };
  for (const cases::CellNodes& cell : mesh.cells) {
    add(cell, cases::reference_cell(mesh.shape).edges, 1);
    if (mesh.shape == cases::CellShape::tetrahedron) continue;
    add(cell, cases::cell_face_diagonals, 2);
    add(cell, cases::cell_internal_diagonals, 3);
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> kinds;
  for (const msm::Link& link : links) {
    const Pair wanted{link.i, link.j, 0};
    const auto found = std::lower_bound(pairs.begin(), pairs.end(), wanted);
    kinds.push_back(found != pairs.end() && !(wanted < *found) ? found->kind : 0);
  }
  return kinds;
}

/// Midlines, and what a body without them would have lost.
std::string midlines_text(const msm::Problem& problem) {
  const msm::Lattice& lattice = problem.lattice;
  const std::vector<int> kinds = kinds_of_links(problem.mesh, lattice.links);
  double of_edges = 0, of_midlines = 0;
  for (std::size_t n = 0; n < kinds.size(); ++n)
    if (kinds[n] == 1)
      of_edges += lattice.links[n].spring.stiffness * std::pow(lattice.links[n].spring.rest_length, 2);
  for (const msm::Midline& m : lattice.midlines)
    of_midlines += m.spring.stiffness * std::pow(m.spring.rest_length, 2);
  return fmt::format(
      "{} springs between the centres of faces, which have {:.0f} % of the stiffness along the cells' edges",
      lattice.midlines.size(), 100 * of_midlines / (of_edges + of_midlines));
}

/// What these springs have that a target cannot say.
std::vector<std::string> inexpressible(ExportTarget target, const msm::Problem& problem) {
  const msm::Lattice& lattice = problem.lattice;
  std::vector<std::string> all;
  if (target == ExportTarget::vtu && !lattice.tetrahedra.empty())
    all.push_back(fmt::format("{} tetrahedra of biquadratic springs", lattice.tetrahedra.size()));
  return all;
}

void write_springs_csv(const std::string& folder, const msm::Lattice& lattice) {
  write_csv_file(folder + "/springs.csv", [&](CsvWriter& csv) {
    csv.row("node_a", "node_b", "stiffness_N_per_m", "rest_length_mm", "exponent");
    for (const auto& [i, j, spring] : lattice.links)
      csv.row(i, j, exact(1e3 * spring.stiffness), exact(spring.rest_length),
              exponent_of(spring) ? exact(spring.law.parameter) : "");
  });
}

void write_nodes_csv(const std::string& folder, const msm::Problem& problem, const ExportedBody& body) {
  const msm::Points displacement = prescribed(problem), force = problem.on_all_points(problem.force);
  write_csv_file(folder + "/nodes.csv", [&](CsvWriter& csv) {
    csv.row("node", "x_mm", "y_mm", "z_mm", "constrained_x", "constrained_y", "constrained_z",
            "displacement_x_mm", "displacement_y_mm", "displacement_z_mm", "force_x_N", "force_y_N",
            "force_z_N", "mass_kg");
    for (std::size_t n = 0; n < problem.lattice.rest.size(); ++n)
      csv.row(n, exact(problem.lattice.rest[n]), constrained(problem, n), exact(displacement[n]),
              exact(force[n]), exact(body.mass.empty() ? 0 : 1e3 * body.mass[n]));
  });
}

void write_volume_terms_csv(const std::string& folder, const msm::Lattice& lattice) {
  write_csv_file(folder + "/volume_terms.csv", [&](CsvWriter& csv) {
    csv.row("stiffness_MPa", "rest_volume_mm3", "law", "node_0", "node_1", "node_2", "node_3", "node_4",
            "node_5", "node_6", "node_7");
    for (const msm::VolumeCell& cell : lattice.volume_cells)
      csv.row(exact(cell.stiffness), exact(cell.rest_volume), cell.is_logarithmic ? "logarithmic" : "linear",
              exact(cell.nodes));
  });
}

/// A row for every tetrahedron of a node's patch, a quarter of whose volume counts.
void write_volume_patches_csv(const std::string& folder, const msm::Lattice& lattice) {
  write_csv_file(folder + "/volume_patches.csv", [&](CsvWriter& csv) {
    csv.row("node", "stiffness_MPa", "rest_volume_mm3", "law", "node_0", "node_1", "node_2", "node_3");
    for (const msm::VolumePatch& patch : lattice.volume_patches)
      for (const std::array<int, 4>& places : patch.tetrahedra)
        csv.row(patch.nodes[0], exact(patch.stiffness), exact(patch.rest_volume),
                patch.is_logarithmic ? "logarithmic" : "linear", exact(cases::pick(patch.nodes, places)));
  });
}

void write_midlines_csv(const std::string& folder, const msm::Lattice& lattice) {
  write_csv_file(folder + "/midlines.csv", [&](CsvWriter& csv) {
    std::vector<std::string> header{"stiffness_N_per_m", "rest_length_mm", "exponent"};
    for (const char* end : {"a", "b"})
      for (int v = 0; v < 4; ++v) header.push_back(fmt::format("node_{}{}", end, v));
    csv.row(header);
    for (const msm::Midline& m : lattice.midlines) {
      std::vector<int> ends[2]; // the means of four nodes each
      for (std::size_t v = 0; v < 8; ++v) ends[m.part(v) > 0 ? 1 : 0].push_back(m.nodes[v]);
      csv.row(exact(1e3 * m.spring.stiffness), exact(m.spring.rest_length),
              exponent_of(m.spring) ? exact(m.spring.law.parameter) : "", exact(ends[0]), exact(ends[1]));
    }
  });
}

void write_tetrahedra_csv(const std::string& folder, const msm::Lattice& lattice) {
  std::vector<std::string> header;
  for (int v = 0; v < 4; ++v) header.push_back(fmt::format("node_{}", v));
  for (const auto& [a, b] : msm::tetrahedron_edges)
    header.push_back(fmt::format("rest_length_{}{}_mm", a, b));
  for (const auto& [a, b] : msm::tetrahedron_edges)
    for (const auto& [c, d] : msm::tetrahedron_edges)
      header.push_back(fmt::format("stiffness_{}{}_{}{}_N_per_mm3", a, b, c, d));
  write_csv_file(folder + "/tetrahedra.csv", [&](CsvWriter& csv) {
    csv.row(header);
    for (const msm::Tetrahedron& t : lattice.tetrahedra)
      csv.row(exact(t.nodes), exact(t.rest_lengths), exact(t.stiffness.reshaped<Eigen::RowMajor>()));
  });
}

std::vector<std::string> write_csv_files(const std::string& folder, const msm::Problem& problem,
                                         const ExportedBody& body) {
  const msm::Lattice& lattice = problem.lattice;
  write_nodes_csv(folder, problem, body);
  write_volume_terms_csv(folder, lattice);
  write_tetrahedra_csv(folder, lattice);
  if (!lattice.midlines.empty()) write_midlines_csv(folder, lattice);
  if (!lattice.volume_patches.empty()) write_volume_patches_csv(folder, lattice);
  if (!lattice.volume_cells.empty()) write_volume_tetrahedra_csv(folder, lattice);
  write_springs_csv(folder, lattice);
  const auto n_negative = std::count_if(lattice.links.begin(), lattice.links.end(),
                                        [](const msm::Link& link) { return link.spring.stiffness < 0; });
  std::vector<std::string> said{
      fmt::format("springs.csv: {} springs", lattice.links.size()),
      fmt::format("nodes.csv: {} nodes with supports, loads and masses", lattice.rest.size()),
      fmt::format("volume_terms.csv: {} cells", lattice.volume_cells.size()),
      fmt::format("tetrahedra.csv: {} tetrahedra of biquadratic springs", lattice.tetrahedra.size())};
  if (!lattice.volume_cells.empty())
    said.push_back(
        fmt::format("volume_tetrahedra.csv: {} tetrahedra in place of the volume terms, for engines "
                    "that have no other constraints of volume",
                    2 * lattice.volume_cells.size()));
  if (!lattice.midlines.empty())
    said.push_back(
        fmt::format("midlines.csv: {} springs between means of four nodes", lattice.midlines.size()));
  if (!lattice.volume_patches.empty())
    said.push_back(fmt::format("volume_patches.csv: the tetrahedra around {} nodes with volume terms",
                               lattice.volume_patches.size()));
  if (n_other_terms(lattice) > 0)
    said.push_back("design = \"network\" reads springs.csv alone, not the other terms");
  if (n_negative > 0)
    said.push_back(
        fmt::format("{} springs have a negative stiffness, which design = \"network\" refuses", n_negative));
  if (!body.skin.vertices.empty()) said.push_back(write_skin_csv(folder, body.skin));
  said.push_back(write_references(folder, lattice, 1));
  copy_program(folder, "export", "Forces.cs", "Forces.cs");
  said.emplace_back("Forces.cs: the same forces in C#");
  return said;
}

std::vector<std::string> write_vtu_file(const std::string& folder, const msm::Problem& problem) {
  const msm::Lattice& lattice = problem.lattice;
  SpringLines lines;
  std::vector<double> kind, is_power_log, exponent;
  for (const int number : kinds_of_links(problem.mesh, lattice.links)) kind.push_back(number);
  for (const auto& [i, j, spring] : lattice.links) {
    lines.add(i, j, spring);
    is_power_log.push_back(exponent_of(spring) ? 1 : 0);
    exponent.push_back(exponent_of(spring).value_or(0));
  }
  msm::Points is_constrained;
  for (std::size_t n = 0; n < lattice.rest.size(); ++n) {
    const std::vector<int> components = constrained(problem, n);
    is_constrained.emplace_back(components[0], components[1], components[2]);
  }
  cases::GridFields fields;
  fields.point_vectors = {{"constrained", is_constrained, "1"},
                          {"prescribed_displacement", prescribed(problem), "mm"},
                          {"force", problem.on_all_points(problem.force), "N"}};
  fields.cell_numbers = {
      {"kind", kind, "1"}, {"is_power_log", is_power_log, "1"}, {"exponent", exponent, "1"}};
  const std::string content = vtu_of_lines(lattice.rest, lines, std::move(fields));
  write_file(folder + "/springs.vtu", [&](std::ostream& out) { out << content; });
  std::vector<std::string> said{
      fmt::format("springs.vtu: {} springs as lines (N/mm, mm)", lattice.links.size())};
  if (!lattice.volume_cells.empty())
    said.push_back(fmt::format("not in it: the volume terms of {} cells (--to csv writes them)",
                               lattice.volume_cells.size()));
  if (!lattice.volume_patches.empty())
    said.push_back(fmt::format("not in it: the volume terms at {} nodes (--to csv writes them)",
                               lattice.volume_patches.size()));
  if (!lattice.midlines.empty())
    said.push_back(fmt::format("not in it: {} (--to csv writes them)", midlines_text(problem)));
  return said;
}

} // namespace

std::vector<int> constrained(const msm::Problem& problem, std::size_t node) {
  std::vector<int> components;
  for (std::size_t a = 0; a < 3; ++a) components.push_back(problem.is_constrained[3 * node + a] ? 1 : 0);
  return components;
}

msm::Points prescribed(const msm::Problem& problem) {
  return problem.on_all_points(problem.supports ? problem.supports(1) : std::vector<cases::NodeVector>{});
}

msm::Problem exported_problem(const cases::Scene& scene) {
  cases::refuse_tools(scene.definition, "export", "the files have no words for tools");
  msm::Problem problem = msm::make_problem(scene);
  problem.lattice = msm::make_lattice(scene.mesh, springs_as_solved(scene, design_for(scene)));
  return problem;
}

std::optional<ExportedMotion> exported_motion(const cases::Scene& scene) {
  if (!scene.definition.dynamics) return std::nullopt;
  ExportedMotion motion{*scene.definition.dynamics,
                        msm::make_inertia(scene, {}),
                        scene.definition.material_dynamics.stiffness_damping,
                        true,
                        scene.moved,
                        {},
                        cases::has_memory(scene.definition)};
  for (const cases::RegionMaterial& region : scene.definition.region_materials)
    if (region.dynamics.stiffness_damping != motion.stiffness_damping)
      motion.has_one_stiffness_damping = false;
  if (motion.dynamics.start == cases::MotionStart::equilibrium) {
    const cases::Scene before = cases::scene_before_start(scene);
    motion.start = msm::Model(before, design_for(before).springs).solve().displacement;
  }
  return motion;
}

ExportedBody exported_body(const cases::Scene& scene) {
  ExportedBody body{cases::point_masses(scene)};
  if (cases::has_cells(scene.definition.body)) body.skin = embedded_surface(scene);
  return body;
}

void check_expressible(ExportTarget target, const std::string& name, const msm::Problem& problem,
                       const std::optional<ExportedMotion>& motion, const ErrorOfDesign& error_of) {
  const auto text = [&](const std::vector<std::string>& missing) {
    return fmt::format("export: --to {} cannot express {} of the case '{}'", cases::name_of(target),
                       fmt::join(missing, ", "), one_line(name));
  };
  if (const auto missing = inexpressible(target, problem); !missing.empty()) {
    const std::string design = problem.mesh.shape == cases::CellShape::tetrahedron ? "van_gelder" : "moduli";
    throw cases::InputError(fmt::format("{}; --to sofa and csv can, and --set msm.design={} makes springs "
                                        "alone{}",
                                        text(missing), design, error_of ? error_of(design) : ""));
  }
  if (target != ExportTarget::sofa || !motion) return;
  if (const auto missing = inexpressible_in_sofa(*motion); !missing.empty())
    throw cases::InputError(text(missing));
}

std::vector<std::string> export_springs(const std::string& folder, ExportTarget target,
                                        const std::string& name, const msm::Problem& problem,
                                        const ExportedBody& body,
                                        const std::optional<ExportedMotion>& motion) {
  if (target == ExportTarget::sofa)
    return write_sofa_files(folder, name, problem, body, motion ? &*motion : nullptr);
  const bool is_csv = target == ExportTarget::csv;
  std::vector<std::string> said =
      is_csv ? write_csv_files(folder, problem, body) : write_vtu_file(folder, problem);
  if (motion)
    said.push_back(fmt::format("not in it: {}damping{}, steps and histories of [dynamics]{}; "
                               "loads and motions are those at a factor of 1",
                               is_csv ? "" : "masses, ",
                               motion->has_memory ? ", the materials' memory (prony)" : "",
                               motion->has_memory ? "" : " (--to sofa writes them)"));
  return said;
}

} // namespace springproof::compare
