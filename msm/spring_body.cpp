#include "msm/spring_body.hpp"

#include <algorithm>
#include <bitset>
#include <cassert>
#include <map>
#include <tuple>
#include <utility>

namespace springproof::msm {

namespace {

using cases::index;

std::pair<int, int> nodes_of(const cases::CellNodes& cell, const CellSpring& spring) {
  return std::minmax({cell[index(spring.vertices[0])], cell[index(spring.vertices[1])]});
}

const CellTerms& terms_of_cell(const BodyTerms& terms, std::size_t cell) {
  return terms.kinds[terms.kind_of_cell.empty() ? 0 : index(terms.kind_of_cell[cell])];
}

/// Number of cells that share a spring inside a grid: four an edge, two a face diagonal.
int n_cells_inside(const CellSpring& spring) {
  return 4 >> (n_axes(spring) - 1);
}

/// How many cells have a spring between two nodes, those of the body's mirror images among them.
std::map<std::pair<int, int>, int> count_cells(const cases::Mesh& mesh, const BodyTerms& terms) {
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

/// Calls action for the cells of a body of terms, as for_each_cell() does.
void for_each_cell_of(const cases::Mesh& mesh, const BodyTerms& terms, const cases::Range& cells,
                      const std::function<void(std::size_t, const CellTerms&)>& action) {
  assert(terms.kind_of_cell.empty() || terms.kind_of_cell.size() == mesh.cells.size());
  const bool is_whole = terms.boundary == Boundary::whole;
  const auto n_cells = is_whole ? count_cells(mesh, terms) : std::map<std::pair<int, int>, int>();
  for (std::size_t c = cells.begin; c < cells.end; ++c) {
    if (!is_whole) {
      action(c, terms_of_cell(terms, c));
      continue;
    }
    CellTerms own = terms_of_cell(terms, c);
    for (CellSpring& spring : own.springs)
      spring.stiffness *= double(n_cells_inside(spring)) / n_cells.at(nodes_of(mesh.cells[c], spring));
    action(c, own);
  }
}

/// The same for cells of four stiffnesses.
void for_each_cell_of([[maybe_unused]] const cases::Mesh& mesh, const std::vector<CellStiffness>& stiffness,
                      const cases::Range& cells,
                      const std::function<void(std::size_t, const CellTerms&)>& action) {
  if (stiffness.empty()) return;
  assert(stiffness.size() == 1 || stiffness.size() == mesh.cells.size());
  CellTerms terms = terms_of(stiffness.front());
  for (std::size_t c = cells.begin; c < cells.end; ++c) {
    if (stiffness.size() > 1) terms = terms_of(stiffness[c]);
    action(c, terms);
  }
}

void for_each_cell_of(const cases::Mesh& /*mesh*/, const Network& /*springs*/, const cases::Range&,
                      const std::function<void(std::size_t, const CellTerms&)>&) {}

using Factor = std::function<double(std::size_t cell)>;

SpringBody scaled_body(const std::vector<CellStiffness>& cells, std::size_t n_cells, const Factor& factor) {
  std::vector<double> factors;
  for (std::size_t c = 0; c < n_cells; ++c) factors.push_back(factor(c));
  const bool are_alike = cells.size() == 1 && std::equal(factors.begin() + 1, factors.end(), factors.begin());
  std::vector<CellStiffness> all;
  for (std::size_t c = 0; c < (are_alike ? 1 : n_cells); ++c)
    all.push_back(scaled(cells[cells.size() == 1 ? 0 : c], factors[c]));
  return all;
}

SpringBody scaled_body(BodyTerms terms, std::size_t n_cells, const Factor& factor) {
  const std::vector<CellTerms> kinds = std::exchange(terms.kinds, {});
  std::map<std::pair<int, double>, int> known; // new kind by kind of cells and factor
  std::vector<int> kind_of_cell;
  for (std::size_t c = 0; c < n_cells; ++c) {
    const int kind = terms.kind_of_cell.empty() ? 0 : terms.kind_of_cell[c];
    const auto [place, is_new] = known.try_emplace({kind, factor(c)}, static_cast<int>(known.size()));
    if (is_new) terms.kinds.push_back(scaled(kinds[index(kind)], factor(c)));
    kind_of_cell.push_back(place->second);
  }
  terms.kind_of_cell = std::move(kind_of_cell);
  return terms;
}

SpringBody scaled_body(Network springs, std::size_t /*n_cells*/, const Factor& factor) {
  for (cases::NetworkSpring& spring : springs) spring.stiffness *= factor(0);
  return springs;
}

/// Links between the same two points become one with the sum of their stiffnesses.
std::vector<Link> merge(std::vector<Link> links) {
  const auto kind = [](const Link& link) { return std::tuple(link.i, link.j, link.spring.law); };
  std::sort(links.begin(), links.end(), [&](const Link& a, const Link& b) { return kind(a) < kind(b); });
  std::vector<Link> merged;
  for (const Link& link : links) {
    if (!merged.empty() && kind(merged.back()) == kind(link))
      merged.back().spring.stiffness += link.spring.stiffness;
    else
      merged.push_back(link);
  }
  return merged;
}

/// Adds the terms of a cell whose vertices are nodes of a lattice; terms of stiffness 0 are left out.
void add_cell(Lattice& lattice, const CellTerms& terms, const cases::CellNodes& nodes, double rest_volume) {
  for (const CellSpring& spring : terms.springs) {
    if (spring.stiffness == 0) continue;
    const auto [i, j] = nodes_of(nodes, spring);
    const double length = (lattice.rest[index(j)] - lattice.rest[index(i)]).norm();
    lattice.links.push_back({i, j, {spring.stiffness, length, spring.law}});
  }
  for (const auto& [axis, stiffness, law] : terms.midlines) {
    Midline midline{cases::hexahedron_nodes(nodes), axis, {stiffness, 0, law}};
    midline.spring.rest_length = midline.between_centres(at_nodes(midline.nodes, lattice.rest)).norm();
    if (stiffness != 0) lattice.midlines.push_back(midline);
  }
  for (const auto& [vertices, lambda, mu] : terms.tetrahedra) {
    const std::array<int, 4> own = cases::pick(nodes, vertices);
    lattice.tetrahedra.push_back(make_tetrahedron(own, at_nodes(own, lattice.rest), lambda, mu));
  }
  if (terms.volume != 0) // tetrahedra have theirs at nodes
    lattice.volume_cells.push_back(
        {cases::hexahedron_nodes(nodes), terms.volume, rest_volume, terms.is_logarithmic});
}

/// Adds a patch for every node of cells whose volume terms are at their nodes. Its stiffness is the mean of
/// the cells', by volume.
/// @param own  numbers and terms of these cells
void add_patches(Lattice& lattice, const cases::Mesh& mesh,
                 const std::vector<std::pair<std::size_t, CellTerms>>& own) {
  std::vector<std::vector<std::size_t>> cells_of(lattice.rest.size()); // places in own
  for (std::size_t n = 0; n < own.size(); ++n)
    for (const int node : mesh.cells[own[n].first]) cells_of[index(node)].push_back(n);
  for (std::size_t node = 0; node < cells_of.size(); ++node) {
    if (cells_of[node].empty()) continue;
    VolumePatch patch{{static_cast<int>(node)}, {}, {}, 0, 0, own[cells_of[node][0]].second.is_logarithmic};
    for (const std::size_t n : cells_of[node]) {
      std::array<int, 4> places{};
      for (std::size_t v = 0; v < 4; ++v) {
        const int vertex = mesh.cells[own[n].first][v];
        const auto known = std::find(patch.nodes.begin(), patch.nodes.end(), vertex);
        places[v] = static_cast<int>(known - patch.nodes.begin());
        if (known == patch.nodes.end()) patch.nodes.push_back(vertex);
      }
      patch.tetrahedra.push_back(places);
      const double volume = cases::cell_volume(cases::cell_corners(mesh, own[n].first)) / 4;
      patch.rest_volume += volume;
      patch.stiffness += own[n].second.volume * volume;
    }
    patch.stiffness /= patch.rest_volume;
    for (int v = 1; v < static_cast<int>(patch.nodes.size()); ++v) patch.edges.push_back({0, v});
    if (patch.stiffness != 0) lattice.volume_patches.push_back(std::move(patch));
  }
}

void add_network(Lattice& lattice, const Network& springs) {
  for (const cases::NetworkSpring& spring : springs) {
    const auto [i, j] = std::minmax(spring.a, spring.b);
    const double distance = (lattice.rest[index(j)] - lattice.rest[index(i)]).norm();
    const SpringLaw law = spring.exponent ? SpringLaw{LawKind::power_log, *spring.exponent} : SpringLaw{};
    lattice.links.push_back({i, j, {spring.stiffness, spring.rest_length.value_or(distance), law}});
  }
  std::sort(lattice.links.begin(), lattice.links.end(),
            [](const Link& a, const Link& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
}

} // namespace

CellTerms terms_of(const CellStiffness& stiffness) {
  CellTerms terms;
  const auto add = [&](const auto& pairs, double k, int n_axes) {
    for (const auto& [v, w] : pairs)
      terms.springs.push_back({{v, w}, k, law_of(stiffness.exponents, n_axes)});
  };
  add(cases::cell_edges, stiffness.edge, 1);
  add(cases::cell_face_diagonals, stiffness.face_diagonal, 2);
  add(cases::cell_internal_diagonals, stiffness.internal_diagonal, 3);
  for (int axis = 0; axis < 3 && stiffness.midline != 0; ++axis)
    terms.midlines.push_back({axis, stiffness.midline, law_of(stiffness.exponents, 1)});
  terms.volume = stiffness.volume;
  terms.is_logarithmic = has_logarithmic_volume(kind_of(stiffness.exponents));
  return terms;
}

CellTerms terms_by_axis(const AxisStiffness& stiffness) {
  CellTerms terms = terms_of(CellStiffness{1, 1, 1});
  for (CellSpring& spring : terms.springs) {
    const int crossed = spring.vertices[0] ^ spring.vertices[1]; // bit a: the axis a
    const std::array<std::size_t, 8> place{0, 0, 1, 5, 2, 4, 3, 6};
    spring.stiffness = stiffness.springs[place[index(crossed)]];
  }
  terms.volume = stiffness.volume;
  return terms;
}

CellTerms scaled(CellTerms terms, double factor) {
  for (CellSpring& spring : terms.springs) spring.stiffness *= factor;
  for (CellMidline& midline : terms.midlines) midline.stiffness *= factor;
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
  for (CellMidline& midline : terms.midlines) midline.law = law_of(exponents, 1);
  terms.is_logarithmic = has_logarithmic_volume(exponents.law);
}

SpringBody scaled(const SpringBody& springs, std::size_t n_cells, const Factor& factor) {
  return std::visit([&](const auto& kind) { return scaled_body(kind, n_cells, factor); }, springs.kind);
}

void for_each_cell(const cases::Mesh& mesh, const SpringBody& springs, const cases::Range& cells,
                   const std::function<void(std::size_t, const CellTerms&)>& action) {
  std::visit([&](const auto& kind) { for_each_cell_of(mesh, kind, cells, action); }, springs.kind);
}

Lattice make_lattice(const cases::Mesh& mesh, const SpringBody& springs) {
  Lattice lattice;
  lattice.rest = mesh.nodes.to_vector();
  if (const Network* network = springs.network()) {
    add_network(lattice, *network);
    return lattice;
  }
  std::vector<std::pair<std::size_t, CellTerms>> of_nodes;
  for_each_cell(mesh, springs, {0, mesh.cells.size()}, [&](std::size_t c, const CellTerms& terms) {
    CellTerms own = terms;
    if (terms.is_at_nodes) {
      of_nodes.push_back({c, {{}, {}, {}, terms.volume, terms.is_logarithmic, true}});
      own.volume = 0;
    }
    add_cell(lattice, own, mesh.cells[c], cases::cell_volume(cases::cell_corners(mesh, c)));
  });
  add_patches(lattice, mesh, of_nodes);
  lattice.links = merge(std::move(lattice.links));
  return lattice;
}

bool has_volume_patches(const SpringBody& springs) {
  const BodyTerms* terms = springs.terms();
  return terms && std::any_of(terms->kinds.begin(), terms->kinds.end(),
                              [](const CellTerms& kind) { return kind.is_at_nodes && kind.volume != 0; });
}

Lattice cell_lattice(const CellTerms& terms, const cases::CellCorners& corners) {
  Lattice lattice;
  lattice.rest.assign(corners.begin(), corners.end());
  lattice.links.reserve(terms.springs.size());
  cases::CellNodes nodes{0, 1, 2, 3, 4, 5, 6, 7};
  nodes.resize(corners.size());
  add_cell(lattice, terms, nodes, cases::cell_volume(corners));
  return lattice;
}

} // namespace springproof::msm
