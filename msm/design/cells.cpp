#include "msm/design/cells.hpp"

#include "cases/case/error.hpp"
#include "mechanics/dense.hpp"
#include "mechanics/larger.hpp"
#include "msm/tangent.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <vector>

namespace springproof::msm {

namespace {

/// @param matrix  24x24, N/mm
Elasticity affine_elasticity(const CellMatrix& matrix, const CellVertices& vertices) {
  static constexpr int axes[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  // Columns: the displacement u = e x at the vertices, e symmetric with unit engineering strain in one
  // component.
  Eigen::Matrix<double, 24, 6> strains;
  for (int c = 0; c < 6; ++c) {
    const auto& [i, j] = axes[c];
    Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
    strain(i, j) += 0.5;
    strain(j, i) += 0.5;
    for (int v = 0; v < 8; ++v)
      strains.block<3, 1>(3 * v, c) = strain * vertices[static_cast<std::size_t>(v)];
  }
  return strains.transpose() * matrix * strains / volume_of(vertices);
}

/// Constants by axis: E along x, y, z, G between them (yz, xz, xy), nu as the strain along the second axis
/// where the first is stretched: xy, xz, yx, yz, zx, zy.
struct Constants {
  std::array<double, 3> youngs_modulus, shear_modulus;
  std::array<double, 6> poissons_ratio;
};

Constants constants_of(const Elasticity& elasticity) {
  const Elasticity compliance = elasticity.inverse();
  Constants found{};
  std::size_t n = 0;
  for (int i = 0; i < 3; ++i) {
    found.youngs_modulus[static_cast<std::size_t>(i)] = 1 / compliance(i, i);
    found.shear_modulus[static_cast<std::size_t>(i)] = 1 / compliance(3 + i, 3 + i);
    for (int j = 0; j < 3; ++j)
      if (j != i) found.poissons_ratio[n++] = -compliance(j, i) / compliance(i, i);
  }
  return found;
}

/// One number where they all print alike.
template<std::size_t n>
std::string numbers_text(const std::array<double, n>& values) {
  std::vector<std::string> texts;
  for (const double value : values)
    texts.push_back(fmt::format("{:.3g}", std::abs(value) < 5e-4 ? 0. : value));
  const bool are_alike =
      std::all_of(texts.begin(), texts.end(), [&](const auto& t) { return t == texts[0]; });
  return are_alike ? texts[0] : fmt::format("({})", fmt::join(texts, ", "));
}

std::string constants_text(const Constants& c) {
  return fmt::format("E {} MPa, nu {}, G {} MPa", numbers_text(c.youngs_modulus),
                     numbers_text(c.poissons_ratio), numbers_text(c.shear_modulus));
}

} // namespace

CellVertices cube(double edge) {
  CellVertices vertices;
  for (int v = 0; v < 8; ++v)
    vertices[static_cast<std::size_t>(v)] = edge * Eigen::Vector3d(v & 1, (v >> 1) & 1, (v >> 2) & 1);
  return vertices;
}

double cube_edge(const CellVertices& vertices) {
  const double edge = (vertices[1] - vertices[0]).norm();
  const CellVertices ideal = cube(edge);
  for (std::size_t v = 1; v < 8; ++v)
    if (!((vertices[v] - vertices[0] - ideal[v]).norm() <= 1e-9 * edge)) return 0;
  return edge;
}

CellMatrix cell_stiffness_matrix(const CellVertices& vertices, const CellTerms& terms) {
  const Lattice lattice = cell_lattice(terms, {vertices.begin(), vertices.end()});
  CellMatrix matrix = CellMatrix::Zero();
  visit_tangent_blocks(lattice, lattice.rest, Clamp::no,
                       [&](int row, int column, const Eigen::Matrix3d& block) {
                         matrix.block<3, 3>(3 * row, 3 * column) += block;
                         if (row != column) matrix.block<3, 3>(3 * column, 3 * row) += block.transpose();
                       });
  return matrix;
}

LatticeModuli cubic_moduli(double c11, double c12, double c44) {
  return {c11, c12, c44, 2 * c44 / (c11 - c12), c11 - 2 * c12 * c12 / (c11 + c12), c12 / (c11 + c12), c44};
}

Elasticity cell_elasticity(const std::vector<CellTerms>& kinds, const CellVertices& vertices) {
  Elasticity sum = Elasticity::Zero();
  for (const CellTerms& kind : kinds)
    sum += affine_elasticity(cell_stiffness_matrix(vertices, kind), vertices);
  return sum / static_cast<double>(kinds.size());
}

LatticeModuli averaged_moduli(const Elasticity& elasticity) {
  return cubic_moduli(elasticity.diagonal().head<3>().mean(),
                      (elasticity(0, 1) + elasticity(1, 2) + elasticity(0, 2)) / 3,
                      elasticity.diagonal().tail<3>().mean());
}

Signs signs_at_rest(const CellMatrix& matrix) {
  const Eigen::VectorXd eigenvalues = mechanics::eigenvalues(matrix);
  // Far above round-off, far below any spring's share.
  const double zero = 1e-9 * eigenvalues.cwiseAbs().maxCoeff();
  return {(eigenvalues.array() < -zero).count(), (eigenvalues.array().abs() <= zero).count()};
}

std::vector<std::string> examine(const CellTerms& terms, const CellVertices& vertices) {
  std::array<std::pair<std::string, std::vector<double>>, 4> parts{{{"edge springs k_e", {}},
                                                                    {"face diagonals k_f", {}},
                                                                    {"internal diagonals k_d", {}},
                                                                    {"volume term k_v", {terms.volume}}}};
  for (const CellSpring& spring : terms.springs)
    parts[cases::index(n_axes(spring) - 1)].second.push_back(spring.stiffness);
  std::vector<std::string> warnings;
  for (const auto& [name, values] : parts) {
    if (!std::all_of(values.begin(), values.end(), [](double k) { return std::isfinite(k); }))
      return {name + ": the stiffness is not a finite number"};
    if (std::any_of(values.begin(), values.end(), [](double k) { return k < 0; }))
      warnings.push_back(name + ": the stiffness is negative");
  }
  const auto [n_negative, n_zero] = signs_at_rest(cell_stiffness_matrix(vertices, terms));
  if (n_negative > 0)
    warnings.push_back(
        fmt::format("the cell's tangent at rest is indefinite: {} negative eigenvalues", n_negative));
  if (n_zero > 6)
    warnings.push_back(
        fmt::format("the cell is a mechanism: {} zero-energy modes besides the rigid motions", n_zero - 6));
  return warnings;
}

ModuliMisfit moduli_misfit(const Elasticity& lattice, const Elasticity& material) {
  const Constants wanted = constants_of(material);
  const Eigen::VectorXd eigenvalues = mechanics::eigenvalues(lattice);
  const double least = eigenvalues.minCoeff(), most = eigenvalues.maxCoeff();
  if (!(least > 1e-9 * most))
    return {std::numeric_limits<double>::infinity(),
            fmt::format("some strain of the lattice at rest costs no energy, where the material has {}",
                        constants_text(wanted))};
  const Constants found = constants_of(lattice);
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (const auto& [of, as] : {std::pair(found.youngs_modulus[i], wanted.youngs_modulus[i]),
                                 {found.shear_modulus[i], wanted.shear_modulus[i]}})
      largest = mechanics::larger(largest, std::abs(of / as - 1));
  for (std::size_t i = 0; i < 6; ++i)
    largest = mechanics::larger(largest, std::abs(found.poissons_ratio[i] - wanted.poissons_ratio[i]));
  return {largest,
          fmt::format("the lattice's moduli are not the material's: {} along its axes, where the material "
                      "has {}",
                      constants_text(found), constants_text(wanted))};
}

namespace {

/// One of the 13 springs that a node of the lattice owns: its rest vector in edges, and the spring that it is
/// in the assembled lattice.
struct NodeSpring {
  Eigen::Vector3d d;
  Spring spring;
};

/// The springs of a node. In a homogeneous deformation midlines are as long as edges: four times their
/// stiffness counts as the edges'.
std::vector<NodeSpring> node_springs(const CellStiffness& k, double edge, double of_midlines = 0) {
  std::vector<NodeSpring> springs;
  const auto add = [&](double stiffness, int n_axes, std::initializer_list<Eigen::Vector3d> directions) {
    for (const Eigen::Vector3d& d : directions)
      springs.push_back({d, {stiffness, edge * d.norm(), law_of(k.exponents, n_axes)}});
  };
  add(4 * k.edge + of_midlines, 1, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  add(2 * k.face_diagonal, 2, {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}});
  add(k.internal_diagonal, 3, {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}});
  return springs;
}

Eigen::Matrix3d cofactor(const Eigen::Matrix3d& f) {
  Eigen::Matrix3d c;
  c.col(0) = f.col(1).cross(f.col(2));
  c.col(1) = f.col(2).cross(f.col(0));
  c.col(2) = f.col(0).cross(f.col(1));
  return c;
}

/// The law of the volume term at a volume ratio J.
VolumeLaw volume_law_of(const CellStiffness& k, double volume_ratio) {
  return volume_law(volume_ratio, has_logarithmic_volume(kind_of(k.exponents)));
}

/// D(q) as a sum over the 27 neighbours of a node, itself included: D(q) = sum_n B_n exp(i q d_n).
struct DynamicalMatrix {
  std::array<Eigen::Matrix3d, 27> blocks; ///< neighbour n lies at (n % 3, n / 3 % 3, n / 9) - 1 edges

  Eigen::Matrix3d& block(const Eigen::Vector3d& d) {
    const Eigen::Vector3i i = d.cast<int>() + Eigen::Vector3i::Ones();
    return blocks[static_cast<std::size_t>(i.x() + 3 * i.y() + 9 * i.z())];
  }
  /// Smallest eigenvalue over |q h|².  @param phase  q h per axis, radians
  double smallest(const Eigen::Vector3d& phase) const {
    // A Hermitian A + iB has the eigenvalues, each twice, of the real [A -B; B A].
    Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3d d(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const Eigen::Matrix3d& block = blocks[static_cast<std::size_t>(n)];
      const double angle = phase.dot(d);
      sum.topLeftCorner<3, 3>() += std::cos(angle) * block;
      sum.bottomLeftCorner<3, 3>() += std::sin(angle) * block;
    }
    sum.bottomRightCorner<3, 3>() = sum.topLeftCorner<3, 3>();
    return mechanics::eigenvalues(sum)(0) / phase.squaredNorm();
  }
};

DynamicalMatrix dynamical_matrix(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  DynamicalMatrix matrix;
  matrix.blocks.fill(Eigen::Matrix3d::Zero());
  for (const auto& [d, spring] : node_springs(stiffness, edge)) {
    const Eigen::Matrix3d block = spring_stiffness(edge * f * d, spring, Clamp::no);
    matrix.block(Eigen::Vector3d::Zero()) += 2 * block;
    matrix.block(d) -= block;
    matrix.block(-d) -= block;
  }
  // Every node is vertex a of one cell and vertex b of another: the second derivatives of one cell's energy,
  // gathered by X_b - X_a.
  const CellPositions vertices = cube(1);
  CellPositions x;
  for (std::size_t v = 0; v < 8; ++v) x[v] = edge * f * vertices[v];
  const auto add = [&](const auto& term) {
    const auto block = term.tangent(x, Clamp::no);
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t b = 0; b < 8; ++b) matrix.block(vertices[b] - vertices[a]) += block(a, b);
  };
  if (stiffness.volume != 0)
    add(VolumeCell{
        {}, stiffness.volume, edge * edge * edge, has_logarithmic_volume(kind_of(stiffness.exponents))});
  for (int axis = 0; axis < 3 && stiffness.midline != 0; ++axis)
    add(Midline{{}, axis, {stiffness.midline, edge, law_of(stiffness.exponents, 1)}});
  return matrix;
}

/// Wave vectors: half of the zone (D(-q) is the conjugate of D(q)) on a grid of pi/4, and long waves along
/// the same directions, which tell whether the continuum loses ellipticity.
std::vector<Eigen::Vector3d> wave_vectors() {
  std::vector<Eigen::Vector3d> all;
  constexpr int n = 4;
  for (int i = 0; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -n; k <= n; ++k) {
        const Eigen::Vector3d q(i, j, k);
        if (q.squaredNorm() == 0) continue;
        all.push_back(q * M_PI / n);
        all.push_back(q.normalized() * 0.01);
      }
  return all;
}

Eigen::Matrix3d uniaxial(double lateral, double axial) {
  return Eigen::Vector3d(lateral, lateral, axial).asDiagonal();
}

/// Whether no wave is unstable under a uniaxial stretch with free sides.
bool is_stable_stretched(const CellStiffness& stiffness, double edge, double stretch) {
  try {
    const double lateral = free_lateral_stretch(stiffness, edge, stretch);
    return smallest_wave_stiffness(stiffness, edge, uniaxial(lateral, stretch)) > 0;
  } catch (const cases::SolveError&) {
    return false; // nothing to be stable about
  }
}

/// Last stable parameter on the way from start to end.
double last_stable(double start, double end, const std::function<bool(double)>& is_stable) {
  const int n_steps = static_cast<int>(std::ceil(std::abs(end - start) / 0.02));
  double good = start;
  for (int i = 0; i <= n_steps; ++i) {
    double bad = start + (end - start) * i / n_steps;
    if (is_stable(bad)) {
      good = bad;
      continue;
    }
    while (std::abs(bad - good) > 1e-4) {
      const double middle = (good + bad) / 2;
      (is_stable(middle) ? good : bad) = middle;
    }
    return good;
  }
  return end;
}

} // namespace

double lattice_energy_density(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  double energy = 0;
  for (const auto& [d, spring] : node_springs(stiffness, edge, stiffness.midline))
    energy += spring_energy(edge * f * d, spring);
  return energy / (edge * edge * edge) +
         stiffness.volume * volume_law_of(stiffness, f.determinant()).integral;
}

Eigen::Matrix3d lattice_stress(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  const double pressure = stiffness.volume * volume_law_of(stiffness, f.determinant()).pressure;
  Eigen::Matrix3d stress = pressure * cofactor(f);
  for (const auto& [d, spring] : node_springs(stiffness, edge, stiffness.midline))
    stress += spring_force(edge * f * d, spring) * d.transpose() / (edge * edge);
  return stress;
}

Eigen::Matrix3d simple_shear(double amount) {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 2) = amount;
  return f;
}

double smallest_wave_stiffness(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  const DynamicalMatrix matrix = dynamical_matrix(stiffness, edge, f);
  double smallest = std::numeric_limits<double>::infinity();
  static const std::vector<Eigen::Vector3d> all = wave_vectors();
  for (const Eigen::Vector3d& phase : all) smallest = std::min(smallest, matrix.smallest(phase));
  return smallest;
}

double free_lateral_stretch(const CellStiffness& stiffness, double edge, double axial_stretch) {
  const auto stress = [&](double lateral) {
    return lattice_stress(stiffness, edge, uniaxial(lateral, axial_stretch))(0, 0);
  };
  double low = 0.05, high = 20; // the sides' stress goes from pressing outwards to pulling inwards
  if (!(stress(low) < 0 && stress(high) > 0))
    throw cases::SolveError("homogeneous lattice: no lateral stretch is free of stress");
  while (high - low > 1e-14 * high) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    (stress(middle) < 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

StabilityRange stability_range(const CellStiffness& stiffness, double edge) {
  const auto is_stable = [&](double stretch) { return is_stable_stretched(stiffness, edge, stretch); };
  return {last_stable(1, search_ends.stretch, is_stable), last_stable(1, search_ends.compression, is_stable),
          last_stable(0, search_ends.shear, [&](double amount) {
            return smallest_wave_stiffness(stiffness, edge, simple_shear(amount)) > 0;
          })};
}

bool is_stable_over(const std::array<double, 2>& strain_range, const CellStiffness& stiffness, double edge) {
  return std::all_of(strain_range.begin(), strain_range.end(),
                     [&](double strain) { return is_stable_stretched(stiffness, edge, std::exp(strain)); });
}

} // namespace springproof::msm
