#include "msm/design/by_shape.hpp"

#include "mechanics/dense.hpp"
#include "mechanics/larger.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace springproof::msm {

namespace {

using cases::index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>; ///< symmetric tensors by Mandel: xx, yy, zz, √2 yz, √2 xz, √2 xy
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Changes of stiffness, over the largest one, below which the descent ends, and its most rounds.
constexpr double small_change = 1e-4;
constexpr int most_rounds = 200;
/// Raise of the energies that are fitted to, 1 each, beyond which springs cannot have the material's mean.
constexpr double most_raised = 1;
/// What the mean may lack of the material's energies of strains, 1 each.
constexpr double lacks_of_mean = 1e-3;

Vector6 mandel(const Vector3d& n) {
  Vector6 m;
  m << n.cwiseProduct(n), std::sqrt(2.) * Vector3d(n.y() * n.z(), n.x() * n.z(), n.x() * n.y());
  return m;
}
Matrix3d tensor(const Vector6& m) {
  const Vector3d s = m.tail<3>() / std::sqrt(2.);
  Matrix3d t;
  t << m[0], s[2], s[1], s[2], m[1], s[0], s[1], s[0], m[2];
  return t;
}

/// a times the deviatoric projection plus b times the volumetric one.
Matrix6 isotropic(double a, double b) {
  Matrix6 matrix = a * Matrix6::Identity();
  matrix.topLeftCorner<3, 3>().array() += (b - a) / 3;
  return matrix;
}

/// C^(-1/2) of a material: its columns are six strains of equal energy.
struct Strains {
  double deviatoric, volumetric;
  explicit Strains(double mu, double kappa)
      : deviatoric(1 / std::sqrt(2 * mu)), volumetric(1 / std::sqrt(3 * kappa)) {}
  /// n ε n of each strain, for a unit vector.
  Vector6 along(const Vector3d& n) const {
    Vector6 m = deviatoric * mandel(n);
    m.head<3>().array() += (volumetric - deviatoric) / 3;
    return m;
  }
  /// The energies of strains in Cauchy's solid, by pairs.
  Matrix6 energies(double mu) const {
    return isotropic(2 * mu * deviatoric * deviatoric, 5 * mu * volumetric * volumetric);
  }
  /// Its stresses, one per column.
  Matrix6 stresses(double mu) const { return isotropic(2 * mu * deviatoric, 5 * mu * volumetric); }
};

struct MeshSpring {
  std::array<int, 2> nodes;
  Vector3d direction; ///< unit vector from the first node to the second
  double length;
  double stiffness;
};

/// The springs of a mesh, each between two nodes.
struct MeshSprings {
  std::vector<MeshSpring> all;
  std::vector<std::size_t> of_cell; ///< places in `all`, cell by cell in the order of springs_of()
};

/// @param parts  stiffnesses of the cells' own springs, in the order of of_cell
MeshSprings springs_of_mesh(const cases::Mesh& mesh, const std::vector<double>& parts) {
  const auto& pairs = springs_of(mesh.shape);
  std::vector<std::tuple<int, int, std::size_t>> places;
  places.reserve(parts.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t s = 0; s < pairs.size(); ++s) {
      const auto [i, j] = std::minmax({mesh.cells[c][index(pairs[s][0])], mesh.cells[c][index(pairs[s][1])]});
      places.emplace_back(i, j, c * pairs.size() + s);
    }
  std::sort(places.begin(), places.end());
  MeshSprings springs{{}, std::vector<std::size_t>(parts.size())};
  for (const auto& [i, j, place] : places) {
    if (springs.all.empty() || springs.all.back().nodes != std::array{i, j}) {
      const Vector3d d = mesh.nodes[index(j)] - mesh.nodes[index(i)];
      springs.all.push_back({{i, j}, d.normalized(), d.norm(), 0});
    }
    springs.all.back().stiffness += parts[place];
    springs.of_cell[place] = springs.all.size() - 1;
  }
  return springs;
}

/// What a node adds to the sum of squares.
struct NodeMisfit {
  double mu = 0, kappa = 0, volume = 0;                                     ///< means by volume; mm³
  double mean_stiffness = 0;                                                ///< D, N/mm
  Eigen::Matrix<double, 3, 6> forces = Eigen::Matrix<double, 3, 6>::Zero(); ///< (f_k - f)/√D
  Matrix6 energies = Matrix6::Zero();                                       ///< √V S (C_k - C) S
  int mirrored = 0; ///< bits of axes whose plane of symmetry has the node: V, D and sums are halves there
  Strains strains() const { return Strains(mu, kappa); }
  /// The other half's part of what is odd along an axis is its opposite.
  void leave_what_mirrors_leave() {
    for (int axis = 0; axis < 3 && mirrored != 0; ++axis) {
      if ((mirrored >> axis & 1) == 0) continue;
      const auto is_odd = [&](int strain) { return strain >= 3 && strain - 3 != axis; }; // shear with it
      for (int strain = 0; strain < 6; ++strain) {
        for (int c = 0; c < 3; ++c)
          if ((c == axis) != is_odd(strain)) forces(c, strain) = 0;
        for (int other = 0; other < 6; ++other)
          if (is_odd(strain) != is_odd(other)) energies(strain, other) = 0;
      }
    }
  }
  double squares() const { return forces.squaredNorm() + energies.squaredNorm(); }
};

/// A spring at one of its ends: what a unit of its stiffness adds to the node's misfits.
struct AtEnd {
  Vector6 along;
  Vector3d force;
  double energy;
  AtEnd(const MeshSpring& spring, std::size_t end, const NodeMisfit& node)
      : along(node.strains().along(spring.direction)),
        force((end == 0 ? -1 : 1) * spring.length / std::sqrt(node.mean_stiffness) * spring.direction),
        energy(spring.length * spring.length / 2 / std::sqrt(node.volume)) {}
  double slope(const NodeMisfit& node) const {
    return force.dot(node.forces * along) + energy * along.dot(node.energies * along);
  }
  double curvature() const {
    const double squared = along.squaredNorm();
    return squared * (force.squaredNorm() + energy * energy * squared);
  }
  void add(NodeMisfit& node, double stiffness) const {
    node.forces += stiffness * force * along.transpose();
    node.energies += stiffness * energy * along * along.transpose();
    node.leave_what_mirrors_leave();
  }
};

/// @param start  the springs that D is taken from
std::vector<NodeMisfit> misfits_of(const cases::Mesh& mesh, const MeshSprings& springs,
                                   const MeshSprings& start, const FitRequest& request) {
  const auto& moduli = request.moduli;
  std::vector<NodeMisfit> nodes(mesh.nodes.size());
  const auto for_each_vertex = [&](const auto& action) {
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      const cases::CellCorners corners = cases::cell_corners(mesh, c);
      const cases::CellCorners gradient = volume_gradient(corners);
      const double share = cases::cell_volume(corners) / double(corners.size());
      for (std::size_t v = 0; v < corners.size(); ++v)
        action(nodes[index(mesh.cells[c][v])], moduli[c], share, gradient[v]);
    }
  };
  for_each_vertex([](NodeMisfit& node, const auto& own, double share, const Vector3d&) {
    node.mu += share * own.mu;
    node.kappa += share * own.kappa;
    node.volume += share;
  });
  for (NodeMisfit& node : nodes) node.mu /= node.volume, node.kappa /= node.volume;
  for (const MeshSpring& spring : start.all)
    for (const int node : spring.nodes) nodes[index(node)].mean_stiffness += spring.stiffness / 3;
  for (const auto& [node, axes] : request.axes_of_node) nodes[index(node)].mirrored = axes;
  for_each_vertex([](NodeMisfit& node, const auto& own, double share, const Vector3d& gradient) {
    node.energies -= share / std::sqrt(node.volume) * node.strains().energies(own.mu);
    const Matrix6 stresses = node.strains().stresses(own.mu);
    for (int strain = 0; strain < 6; ++strain)
      node.forces.col(strain) -= tensor(stresses.col(strain)) * gradient / std::sqrt(node.mean_stiffness);
  });
  for (const MeshSpring& spring : springs.all)
    for (std::size_t end = 0; end < 2; ++end) {
      NodeMisfit& node = nodes[index(spring.nodes[end])];
      AtEnd(spring, end, node).add(node, spring.stiffness);
    }
  for (NodeMisfit& node : nodes) node.leave_what_mirrors_leave();
  return nodes;
}

/// Root of the mean square, as a part of the energies of the strains, which are 1 each.
double mean_misfit(const std::vector<NodeMisfit>& nodes) {
  double sum = 0, volume = 0;
  for (const NodeMisfit& node : nodes) sum += node.squares(), volume += node.volume;
  return std::sqrt(sum / (6 * volume));
}

/// What the energies are to be in the mean over the mesh: of the least squares, or the material's.
enum class Mean { free, of_material };

/// Finds the least squares. For the material's mean, multipliers raise what all nodes are fitted to, and each
/// round adds to them what the mean lacks (Uzawa's method).
/// @return false where springs cannot have that mean
bool descend(MeshSprings& springs, std::vector<NodeMisfit>& nodes, Mean wanted) {
  NodeMisfit mean;
  for (const NodeMisfit& node : nodes) mean.volume += node.volume, mean.mirrored |= node.mirrored;
  Matrix6 raised = Matrix6::Zero();
  const auto raise = [&](const Matrix6& by) {
    raised += by;
    for (NodeMisfit& node : nodes) node.energies -= std::sqrt(node.volume) * by;
  };
  bool is_settled = false; // the stiffnesses are, for what is raised now
  double lacks = 0;
  for (int round = 0; round < most_rounds; ++round) {
    double change = 0, largest = 0;
    for (MeshSpring& spring : springs.all) {
      NodeMisfit &first = nodes[index(spring.nodes[0])], &second = nodes[index(spring.nodes[1])];
      const AtEnd a(spring, 0, first), b(spring, 1, second);
      const double step = -(a.slope(first) + b.slope(second)) / (a.curvature() + b.curvature());
      const double stiffness = std::max(0., spring.stiffness + step), by = stiffness - spring.stiffness;
      a.add(first, by);
      b.add(second, by);
      spring.stiffness = stiffness;
      change = mechanics::larger(change, std::abs(by));
      largest = mechanics::larger(largest, stiffness);
    }
    is_settled = change <= small_change * largest;
    if (wanted == Mean::free) {
      if (is_settled) break;
      continue;
    }
    mean.energies = raised;
    for (const NodeMisfit& node : nodes)
      mean.energies += std::sqrt(node.volume) / mean.volume * node.energies;
    mean.leave_what_mirrors_leave();
    lacks = mean.energies.norm();
    if (is_settled && lacks <= lacks_of_mean) break;
    raise(-mean.energies);
    if (!(raised.norm() <= most_raised)) return false;
  }
  raise(-raised);
  return lacks <= lacks_of_mean;
}

/// k l² over V mu of a cell's springs: in cubes the hybrid lattice, in tetrahedra alike for all edges.
std::vector<double> shares_of(cases::CellShape shape, double split) {
  if (shape == cases::CellShape::tetrahedron) return std::vector<double>(6, 15. / 6);
  std::vector<double> shares(12, (3 - 2 * (1 - split) - split) / 4); // K_e = 3 - 2 K_f - 4 K_d/3
  shares.insert(shares.end(), 12, 1 - split);                        // K_f l²/2
  shares.insert(shares.end(), 4, 3 * 0.75 * split);                  // K_d l²
  return shares;
}

/// Stiffnesses to start from.
std::vector<double> start_of(const cases::CellCorners& corners, double mu, double split) {
  const cases::CellShape shape = cases::shape_of(corners.size());
  const auto& pairs = springs_of(shape);
  std::vector<double> stiffness = shares_of(shape, split);
  for (std::size_t s = 0; s < pairs.size(); ++s)
    stiffness[s] *= mu * cases::cell_volume(corners) /
                    (corners[index(pairs[s][1])] - corners[index(pairs[s][0])]).squaredNorm();
  return stiffness;
}

/// Divides the springs of the mesh among their cells by mu V, as they had them before, and adds volume terms.
std::vector<CellTerms> cells_of(const cases::Mesh& mesh, const MeshSprings& springs,
                                const std::vector<mechanics::ElasticModuli>& moduli) {
  const auto& pairs = springs_of(mesh.shape);
  std::vector<double> sums(springs.all.size(), 0), weights;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    weights.push_back(moduli[c].mu * cases::cell_volume(cases::cell_corners(mesh, c)));
    for (std::size_t s = 0; s < pairs.size(); ++s) sums[springs.of_cell[c * pairs.size() + s]] += weights[c];
  }
  std::vector<CellTerms> cells(mesh.cells.size());
  double springs_bulk = 0, cauchy_bulk = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (std::size_t s = 0; s < pairs.size(); ++s) {
      const std::size_t of = springs.of_cell[c * pairs.size() + s];
      const double part = springs.all[of].stiffness * weights[c] / sums[of];
      cells[c].springs.push_back({pairs[s], part});
      springs_bulk += part * springs.all[of].length * springs.all[of].length / 9;
    }
    cauchy_bulk += 5. / 3 * weights[c];
    cells[c].is_at_nodes = mesh.shape == cases::CellShape::tetrahedron;
  }
  const double part = springs_bulk / cauchy_bulk;
  for (std::size_t c = 0; c < cells.size(); ++c)
    cells[c].volume = moduli[c].kappa - part * 5. / 3 * moduli[c].mu;
  return cells;
}

int count_loose_nodes(const MeshSprings& springs, std::size_t n_nodes) {
  std::vector<Matrix3d> held(n_nodes, Matrix3d::Zero());
  for (const MeshSpring& spring : springs.all)
    for (const int node : spring.nodes)
      held[index(node)] += spring.stiffness * spring.direction * spring.direction.transpose();
  return static_cast<int>(std::count_if(held.begin(), held.end(), [](const Matrix3d& matrix) {
    const Vector3d values = mechanics::eigenvalues(matrix);
    return !(values[0] > 1e-9 * values[2]);
  }));
}

} // namespace

const std::vector<std::array<int, 2>>& springs_of(cases::CellShape shape) {
  static const std::vector<std::array<int, 2>> tetrahedron(tetrahedron_edges.begin(),
                                                           tetrahedron_edges.end());
  static const std::vector<std::array<int, 2>> hexahedron = [] {
    std::vector<std::array<int, 2>> all(cases::cell_edges.begin(), cases::cell_edges.end());
    all.insert(all.end(), cases::cell_face_diagonals.begin(), cases::cell_face_diagonals.end());
    all.insert(all.end(), cases::cell_internal_diagonals.begin(), cases::cell_internal_diagonals.end());
    return all;
  }();
  return shape == cases::CellShape::tetrahedron ? tetrahedron : hexahedron;
}

CellFit fit_cell(const cases::CellCorners& corners, const mechanics::ElasticModuli& moduli, double split) {
  const auto& pairs = springs_of(cases::shape_of(corners.size()));
  CellFit fit{start_of(corners, moduli.mu, split), 0};
  const double volume = cases::cell_volume(corners);
  const Strains strains(moduli.mu, moduli.kappa);
  std::vector<Vector6> units; // a unit of stiffness adds their dyads
  Matrix6 misfit = -strains.energies(moduli.mu);
  for (std::size_t s = 0; s < pairs.size(); ++s) {
    const Vector3d d = corners[index(pairs[s][1])] - corners[index(pairs[s][0])];
    units.emplace_back(strains.along(d.normalized()) * (d.norm() / std::sqrt(volume)));
    misfit += fit.stiffness[s] * units[s] * units[s].transpose();
  }
  for (int round = 0; round < most_rounds; ++round) {
    double change = 0, largest = 0;
    for (std::size_t s = 0; s < pairs.size(); ++s) {
      const double step = -units[s].dot(misfit * units[s]) / std::pow(units[s].squaredNorm(), 2);
      const double stiffness = std::max(0., fit.stiffness[s] + step), by = stiffness - fit.stiffness[s];
      misfit += by * units[s] * units[s].transpose();
      fit.stiffness[s] = stiffness;
      change = mechanics::larger(change, std::abs(by));
      largest = mechanics::larger(largest, stiffness);
    }
    if (change <= small_change * largest) break;
  }
  fit.misfit = misfit.norm() / std::sqrt(6.);
  return fit;
}

ShapeFit fit_by_shape(const cases::Mesh& mesh, const FitRequest& request) {
  const auto& moduli = request.moduli;
  const double split = request.split;
  std::vector<double> start, alone, misfits;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const cases::CellCorners corners = cases::cell_corners(mesh, c);
    const std::vector<double> own = start_of(corners, moduli[c].mu, split);
    start.insert(start.end(), own.begin(), own.end());
    const CellFit fit = fit_cell(corners, moduli[c], split);
    misfits.push_back(fit.misfit);
    alone.insert(alone.end(), fit.stiffness.begin(), fit.stiffness.end());
  }
  ShapeFit fit{};
  fit.worst_misfit = *std::max_element(misfits.begin(), misfits.end());
  const auto middle = misfits.begin() + static_cast<std::ptrdiff_t>(misfits.size() / 2);
  std::nth_element(misfits.begin(), middle, misfits.end());
  fit.median_misfit = *middle;
  const MeshSprings at_start = springs_of_mesh(mesh, start);
  fit.cell_by_cell = mean_misfit(misfits_of(mesh, springs_of_mesh(mesh, alone), at_start, request));
  MeshSprings springs = at_start;
  std::vector<NodeMisfit> nodes = misfits_of(mesh, springs, at_start, request);
  // Coarse tetrahedra lock, which the softness of the free mean offsets.
  const Mean wanted = mesh.shape == cases::CellShape::hexahedron ? Mean::of_material : Mean::free;
  if (!descend(springs, nodes, wanted)) {
    springs = at_start;
    nodes = misfits_of(mesh, springs, at_start, request);
    descend(springs, nodes, Mean::free);
  }
  fit.over_the_mesh = mean_misfit(nodes);
  fit.cells = cells_of(mesh, springs, moduli);
  fit.n_loose_nodes = count_loose_nodes(springs, mesh.nodes.size());
  return fit;
}

std::vector<CellTerms> uniform_by_shape(const cases::Mesh& mesh, const std::vector<double>& youngs_modulus,
                                        std::optional<double> stiffness) {
  const auto& pairs = springs_of(mesh.shape);
  MeshSprings springs = springs_of_mesh(mesh, std::vector<double>(mesh.cells.size() * pairs.size(), 1));
  double wanted = 0, squares = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    wanted += 6 * youngs_modulus[c] * cases::cell_volume(cases::cell_corners(mesh, c));
  for (const MeshSpring& spring : springs.all) squares += spring.length * spring.length;
  std::vector<CellTerms> cells(mesh.cells.size());
  for (std::size_t p = 0; p < springs.of_cell.size(); ++p)
    cells[p / pairs.size()].springs.push_back(
        {pairs[p % pairs.size()],
         stiffness.value_or(wanted / squares) / springs.all[springs.of_cell[p]].stiffness});
  return cells;
}

} // namespace springproof::msm
