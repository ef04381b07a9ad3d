#include "msm/cell_terms.hpp"

#include <bitset>
#include <cassert>
#include <map>

namespace springproof::msm {

namespace {

using cases::index;

std::pair<int, int> nodes_of(const std::array<int, 8>& cell, const CellSpring& spring) {
  return std::minmax({cell[index(spring.vertices[0])], cell[index(spring.vertices[1])]});
}

const CellTerms& terms_of_cell(const BodyTerms& terms, std::size_t cell) {
  return terms.kinds[terms.kind_of_cell.empty() ? 0 : index(terms.kind_of_cell[cell])];
}

/// Of a spring inside a grid: four cells share an edge, two a face diagonal.
int n_cells_inside(const CellSpring& spring) {
  return 4 >> (n_axes(spring) - 1);
}

/// How many cells have a spring between two nodes, those of the body's mirror images among them.
std::map<std::pair<int, int>, int> count_cells(const cases::HexMesh& mesh, const BodyTerms& terms) {
  std::map<std::pair<int, int>, int> n_cells;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const CellSpring& spring : terms_of_cell(terms, c).springs)
      ++n_cells[nodes_of(mesh.cells[c], spring)];
  if (terms.planes_of_node.empty()) return n_cells;
  for (auto& [nodes, n] : n_cells) {
    const int common = terms.planes_of_node[index(nodes.first)] & terms.planes_of_node[index(nodes.second)];
    n <<= std::bitset<32>(static_cast<unsigned>(common)).count();
  }
  return n_cells;
}

} // namespace

CellTerms terms_of(const CellStiffness& stiffness) {
  CellTerms terms;
  for_each_spring(stiffness, [&](int v, int w, double k, const SpringLaw& law) {
    terms.springs.push_back({{v, w}, k, law});
  });
  terms.volume = stiffness.volume;
  terms.is_logarithmic = has_logarithmic_volume(kind_of(stiffness.exponents));
  return terms;
}

CellTerms terms_by_axis(const std::array<double, 7>& stiffness, double volume) {
  CellTerms terms = terms_of(CellStiffness{1, 1, 1});
  for (CellSpring& spring : terms.springs) {
    const int crossed = spring.vertices[0] ^ spring.vertices[1]; // bit a: the axis a
    const std::array<std::size_t, 8> place{0, 0, 1, 5, 2, 4, 3, 6};
    spring.stiffness = stiffness[place[static_cast<std::size_t>(crossed)]];
  }
  terms.volume = volume;
  return terms;
}

CellTerms scaled(CellTerms terms, double factor) {
  for (CellSpring& spring : terms.springs) spring.stiffness *= factor;
  for (CellTetrahedron& tetrahedron : terms.tetrahedra)
    for (double* of : {&tetrahedron.lambda, &tetrahedron.mu}) *of *= factor;
  terms.volume *= factor;
  return terms;
}

int n_axes(const CellSpring& spring) {
  const int crossed = spring.vertices[0] ^ spring.vertices[1];
  return (crossed & 1) + ((crossed >> 1) & 1) + ((crossed >> 2) & 1);
}

void set_exponents(CellTerms& terms, const Exponents& exponents) {
  for (CellSpring& spring : terms.springs) spring.law = law_of(exponents, n_axes(spring));
  terms.is_logarithmic = has_logarithmic_volume(exponents.law);
}

void for_each_cell(const cases::HexMesh& mesh, const BodyTerms& terms, const cases::Range& cells,
                   const std::function<void(std::size_t, const CellTerms&)>& action) {
  assert(terms.kind_of_cell.empty() || terms.kind_of_cell.size() == mesh.cells.size());
  const bool is_whole = terms.boundary == Boundary::whole;
  const auto n_cells = is_whole ? count_cells(mesh, terms) : std::map<std::pair<int, int>, int>();
  for (std::size_t c = cells.begin; c < cells.end; ++c) {
    const CellTerms& of_kind = terms_of_cell(terms, c);
    if (!is_whole) {
      action(c, of_kind);
      continue;
    }
    CellTerms own = of_kind;
    for (CellSpring& spring : own.springs)
      spring.stiffness *= double(n_cells_inside(spring)) / n_cells.at(nodes_of(mesh.cells[c], spring));
    action(c, own);
  }
}

Lattice make_lattice(const cases::HexMesh& mesh, const BodyTerms& terms) {
  Lattice lattice;
  lattice.rest = mesh.nodes.to_vector();
  for_each_cell(mesh, terms, {0, mesh.cells.size()}, [&](std::size_t c, const CellTerms& of_cell) {
    const std::array<int, 8> cell = mesh.cells[c];
    for (const CellSpring& spring : of_cell.springs) {
      const auto nodes = nodes_of(cell, spring);
      if (spring.stiffness != 0)
        lattice.links.push_back({nodes.first, nodes.second, {spring.stiffness, 0, spring.law}});
    }
    for (const CellTetrahedron& tetrahedron : of_cell.tetrahedra)
      lattice.tetrahedra.push_back(make_tetrahedron(cases::pick(cell, tetrahedron.vertices), lattice.rest,
                                                    tetrahedron.lambda, tetrahedron.mu));
    if (of_cell.volume != 0)
      lattice.volume_cells.push_back(
          {cell, of_cell.volume, cases::cell_volume(cases::cell_vertices(mesh, c)), of_cell.is_logarithmic});
  });
  finish_links(lattice);
  return lattice;
}

} // namespace springproof::msm
