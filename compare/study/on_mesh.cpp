#include "compare/study/on_mesh.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "compare/solve/solvers.hpp"
#include "compare/solve/springs.hpp"
#include "compare/write/write.hpp"
#include "msm/design/patch.hpp"
#include "msm/design/small_strain.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

using cases::index;

/// Motions beyond the rigid ones that are looked for.
constexpr int most_motions = 20;
/// The largest eigenvalue of the free stiffness, over its mean diagonal, that counts as zero. Rounding leaves
/// 1e-16, and the lowest mode of a beam of a thousand cells has 1e-9.
constexpr double zero_mode_part = 1e-12;

/// The lattice of a scene, whose springs are without tension at rest.
msm::Lattice lattice_at_rest(const cases::Scene& scene, const msm::SpringBody& springs) {
  msm::Lattice lattice = msm::make_lattice(scene.mesh, springs);
  if (springs.network())
    for (msm::Link& link : lattice.links)
      link.spring.rest_length = (lattice.rest[index(link.j)] - lattice.rest[index(link.i)]).norm();
  return lattice;
}

/// The material of all cells around each node that is on no boundary, else -1.
std::vector<int> materials_inside(const cases::Scene& scene) {
  constexpr int unknown = -2, none = -1;
  std::vector<int> of_node(scene.mesh.nodes.size(), unknown);
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    for (const int node : scene.mesh.cells[c]) {
      int& material = of_node[index(node)];
      const int own = cases::material_of(scene, c);
      material = material == unknown || material == own ? own : none;
    }
  for (const cases::FaceNodes& face : cases::boundary_faces(scene.mesh))
    for (const int node : face) of_node[index(node)] = none;
  return of_node;
}

/// Sums over the cells of one material.
struct Sums {
  msm::Elasticity elasticity = msm::Elasticity::Zero(); ///< times the volume
  double volume = 0;
  std::vector<double> misfits{};
};

std::vector<Sums> sums_of(const cases::Scene& scene, const msm::SpringBody& springs,
                          const msm::Lattice& lattice,
                          const std::vector<std::optional<msm::Elasticity>>& wanted) {
  std::vector<Sums> sums(wanted.size());
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    sums[index(cases::material_of(scene, c))].volume +=
        cases::cell_volume(cases::cell_corners(scene.mesh, c));
  msm::for_each_cell(scene.mesh, springs, {0, scene.mesh.cells.size()},
                     [&](std::size_t c, const msm::CellTerms& terms) {
                       const std::size_t material = index(cases::material_of(scene, c));
                       const cases::CellCorners corners = cases::cell_corners(scene.mesh, c);
                       const msm::Elasticity own = msm::cell_elasticity(terms, corners);
                       sums[material].elasticity += cases::cell_volume(corners) * own;
                       if (wanted[material])
                         sums[material].misfits.push_back(msm::strain_misfit(own, *wanted[material]));
                     });
  if (springs.network()) // which is in a scene of one material
    for (const msm::Link& link : lattice.links)
      sums[0].elasticity += msm::spring_elasticity(lattice.rest[index(link.j)] - lattice.rest[index(link.i)],
                                                   link.spring.stiffness);
  return sums;
}

std::vector<MaterialOnMesh> look_at_materials(const cases::Scene& scene, const msm::SpringBody& springs,
                                              const msm::Lattice& lattice) {
  std::vector<std::optional<msm::Elasticity>> wanted;
  for (const cases::Material& material : cases::materials_of(scene.definition))
    wanted.push_back(msm::elasticity_at_rest(material));
  std::vector<Sums> sums = sums_of(scene, springs, lattice, wanted);
  const std::vector<int> inside = materials_inside(scene);
  std::vector<MaterialOnMesh> all(wanted.size());
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    ++all[index(cases::material_of(scene, c))].n_cells;
  for (std::size_t m = 0; m < all.size(); ++m) {
    if (all[m].n_cells == 0) continue;
    const msm::Elasticity uniform = sums[m].elasticity / sums[m].volume;
    if (wanted[m]) all[m].wanted = msm::averaged_moduli(*wanted[m]);
    all[m].uniform = msm::averaged_moduli(uniform);
    if (std::vector<double>& misfits = sums[m].misfits; !misfits.empty()) {
      std::sort(misfits.begin(), misfits.end());
      all[m].median_misfit = misfits[misfits.size() / 2];
      all[m].worst_misfit = misfits.back();
    }
    std::vector<bool> is_free;
    for (const int material : inside) is_free.push_back(material == static_cast<int>(m));
    all[m].n_inner = static_cast<std::size_t>(std::count(is_free.begin(), is_free.end(), true));
    if (!is_matrix_made(scene.mesh))
      all[m].not_relaxed = fmt::format("not for grids of more than {} nodes", msm::most_factorised);
    else if (all[m].n_inner == 0)
      all[m].not_relaxed = "no node lies inside";
    else if (const auto [released, is_stable] = msm::relax(lattice, is_free, sums[m].volume); is_stable)
      all[m].relaxed = msm::averaged_moduli(uniform - released);
    else
      all[m].not_relaxed = "the inner nodes have no stable equilibrium";
  }
  return all;
}

FreeMotions free_motions(const msm::Lattice& lattice) {
  const Eigen::SparseMatrix<double> stiffness = msm::free_stiffness(lattice);
  const double zero = zero_mode_part * stiffness.diagonal().cwiseAbs().mean();
  constexpr int n_rigid = 6;
  const int n_pairs = static_cast<int>(std::min<Eigen::Index>(stiffness.rows(), n_rigid + most_motions));
  FreeMotions found;
  if (!(zero > 0)) return {n_pairs - n_rigid, true, 0, {}}; // no springs
  const mechanics::Spectrum lowest = solvers().lowest_spectrum(stiffness, n_pairs);
  std::vector<Eigen::Index> columns;
  for (Eigen::Index mode = 0; mode < lowest.values.size(); ++mode) {
    if (lowest.values[mode] < -zero)
      ++found.n_unstable;
    else if (lowest.values[mode] <= zero)
      columns.push_back(mode);
  }
  const msm::ZeroModes modes = msm::zero_modes(lattice.rest, lowest.vectors(Eigen::all, columns));
  found.n = modes.n;
  found.are_more = static_cast<int>(columns.size()) + found.n_unstable == n_pairs &&
                   n_pairs < static_cast<int>(stiffness.rows());
  if (!found.are_more) found.nodes = modes.nodes;
  return found;
}

DesignOnMesh look_at(const cases::Scene& scene) {
  DesignOnMesh found{cases::name_of(scene.definition.msm.design)};
  const msm::DesignResult design = design_for(scene);
  const msm::Lattice lattice = lattice_at_rest(scene, design.springs);
  found.springs = springs_text(design);
  found.warnings = design.warnings;
  found.materials = look_at_materials(scene, design.springs, lattice);
  try {
    if (is_matrix_made(scene.mesh)) found.motions = free_motions(lattice);
  } catch (const cases::SolveError& error) {
    found.warnings.push_back(std::string("zero modes are not known: ") + error.what());
  }
  return found;
}

} // namespace

bool is_matrix_made(const cases::Mesh& mesh) {
  return !mesh.grid || mesh.nodes.size() <= msm::most_factorised;
}

SpringsOnMesh study_on_mesh(const cases::Scene& scene, const std::vector<cases::Design>& designs) {
  SpringsOnMesh study{scene};
  if (designs.empty()) study.designs.push_back(look_at(scene));
  for (const cases::Design design : designs) {
    try {
      study.designs.push_back(look_at(with_design(scene, design)));
    } catch (const cases::InputError& error) {
      study.designs.push_back({cases::name_of(design), error.what()});
    }
  }
  return study;
}

} // namespace springproof::compare
