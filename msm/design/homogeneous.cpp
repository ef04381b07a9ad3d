#include "msm/design/homogeneous.hpp"

#include "cases/case/error.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <vector>

namespace springproof::msm {

namespace {

/// One of the 13 springs that a node of the lattice owns: its rest vector in edges, and its assembled
/// stiffness.
struct NodeSpring {
  Eigen::Vector3d d;
  double stiffness;
};

std::array<NodeSpring, 13> node_springs(const CellStiffness& k) {
  const double e = 4 * k.edge, f = 2 * k.face_diagonal, d = k.internal_diagonal;
  return {{{{1, 0, 0}, e},
           {{0, 1, 0}, e},
           {{0, 0, 1}, e},
           {{1, 1, 0}, f},
           {{1, -1, 0}, f},
           {{1, 0, 1}, f},
           {{1, 0, -1}, f},
           {{0, 1, 1}, f},
           {{0, 1, -1}, f},
           {{1, 1, 1}, d},
           {{1, 1, -1}, d},
           {{1, -1, 1}, d},
           {{1, -1, -1}, d}}};
}

Eigen::Matrix3d cofactor(const Eigen::Matrix3d& f) {
  Eigen::Matrix3d c;
  c.col(0) = f.col(1).cross(f.col(2));
  c.col(1) = f.col(2).cross(f.col(0));
  c.col(2) = f.col(0).cross(f.col(1));
  return c;
}

Eigen::Vector3d vertex(int v) {
  return {static_cast<double>(v & 1), static_cast<double>((v >> 1) & 1), static_cast<double>((v >> 2) & 1)};
}

/// D(q) as a sum over the 27 neighbours of a node, itself included: D(q) = sum_n B_n exp(i q d_n).
struct DynamicalMatrix {
  std::array<Eigen::Matrix3d, 27> blocks;
  std::array<Eigen::Vector3d, 27> neighbours; ///< d_n in edges

  Eigen::Matrix3d& block(const Eigen::Vector3d& d) {
    const Eigen::Vector3i i = d.cast<int>() + Eigen::Vector3i::Ones();
    return blocks[static_cast<std::size_t>(i.x() + 3 * i.y() + 9 * i.z())];
  }
  /// Smallest eigenvalue over |q h|².  @param phase  q h per axis, radians
  double smallest(const Eigen::Vector3d& phase) const {
    Eigen::Matrix3cd sum = Eigen::Matrix3cd::Zero();
    for (std::size_t n = 0; n < 27; ++n) sum += blocks[n] * std::polar(1.0, phase.dot(neighbours[n]));
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3cd>(sum, Eigen::EigenvaluesOnly).eigenvalues()(0) /
           phase.squaredNorm();
  }
};

/// Every node is vertex a of one cell and vertex b of another: the second derivatives of one cell's energy,
/// gathered by X_b - X_a.
void add_volume_terms(DynamicalMatrix& matrix, double stiffness, double edge, const Eigen::Matrix3d& f) {
  CellPositions x;
  for (int v = 0; v < 8; ++v) x[static_cast<std::size_t>(v)] = edge * f * vertex(v);
  const double rest_volume = edge * edge * edge;
  const CellGradient gradient = trilinear_volume_gradient(x);
  const double pressure = stiffness * (trilinear_volume(x) / rest_volume - 1);
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b)
      matrix.block(vertex(b) - vertex(a)) += stiffness / rest_volume * gradient[static_cast<std::size_t>(a)] *
                                                 gradient[static_cast<std::size_t>(b)].transpose() +
                                             pressure * trilinear_volume_second_derivative(x, a, b);
}

DynamicalMatrix dynamical_matrix(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  DynamicalMatrix matrix;
  for (int n = 0; n < 27; ++n) {
    matrix.neighbours[static_cast<std::size_t>(n)] = Eigen::Vector3d(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    matrix.blocks[static_cast<std::size_t>(n)].setZero();
  }
  for (const NodeSpring& spring : node_springs(stiffness)) {
    const Eigen::Matrix3d block = spring_stiffness(
        edge * f * spring.d, {spring.stiffness, edge * spring.d.norm()}, TransverseTerm::exact);
    matrix.block(Eigen::Vector3d::Zero()) += 2 * block;
    matrix.block(spring.d) -= block;
    matrix.block(-spring.d) -= block;
  }
  if (stiffness.volume != 0) add_volume_terms(matrix, stiffness.volume, edge, f);
  return matrix;
}

/// Wave vectors: half of the zone (D(-q) is the conjugate of D(q)) on a grid of pi/4, and long waves along
/// the same directions, which tell whether the continuum loses ellipticity.
const std::vector<Eigen::Vector3d>& wave_vectors() {
  static const std::vector<Eigen::Vector3d> all = [] {
    std::vector<Eigen::Vector3d> list;
    constexpr int n = 4;
    for (int i = 0; i <= n; ++i)
      for (int j = -n; j <= n; ++j)
        for (int k = -n; k <= n; ++k) {
          const Eigen::Vector3d q(i, j, k);
          if (q.squaredNorm() == 0) continue;
          list.push_back(q * M_PI / n);
          list.push_back(q.normalized() * 0.01);
        }
    return list;
  }();
  return all;
}

Eigen::Matrix3d uniaxial(double lateral, double axial) {
  return Eigen::Vector3d(lateral, lateral, axial).asDiagonal();
}

Eigen::Matrix3d simple_shear(double amount) {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 2) = amount;
  return f;
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
  for (const NodeSpring& spring : node_springs(stiffness))
    energy += spring_energy(edge * f * spring.d, {spring.stiffness, edge * spring.d.norm()});
  const double dilatation = f.determinant() - 1;
  return energy / (edge * edge * edge) + 0.5 * stiffness.volume * dilatation * dilatation;
}

Eigen::Matrix3d lattice_stress(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  Eigen::Matrix3d stress = stiffness.volume * (f.determinant() - 1) * cofactor(f);
  for (const NodeSpring& spring : node_springs(stiffness))
    stress += spring_force(edge * f * spring.d, {spring.stiffness, edge * spring.d.norm()}) *
              spring.d.transpose() / (edge * edge);
  return stress;
}

double smallest_wave_stiffness(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  const DynamicalMatrix matrix = dynamical_matrix(stiffness, edge, f);
  double smallest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& phase : wave_vectors()) smallest = std::min(smallest, matrix.smallest(phase));
  return smallest;
}

double free_lateral_stretch(const CellStiffness& stiffness, double edge, double axial_stretch) {
  const auto stress = [&](double lateral) {
    return lattice_stress(stiffness, edge, uniaxial(lateral, axial_stretch))(0, 0);
  };
  double low = 0.05, high = 20; // the sides' stress goes from pressing outwards to pulling inwards
  if (!(stress(low) < 0 && stress(high) > 0))
    throw cases::SolveError("homogeneous lattice: no lateral stretch is free of stress", 0, 0);
  while (high - low > 1e-14 * high) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    (stress(middle) < 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

StabilityRange stability_range(const CellStiffness& stiffness, double edge) {
  const auto stable = [&](const Eigen::Matrix3d& f) {
    return smallest_wave_stiffness(stiffness, edge, f) > 0;
  };
  const auto stable_stretch = [&](double stretch) {
    try {
      return stable(uniaxial(free_lateral_stretch(stiffness, edge, stretch), stretch));
    } catch (const cases::SolveError&) {
      return false; // nothing to be stable about
    }
  };
  return {last_stable(1, search_ends.stretch, stable_stretch),
          last_stable(1, search_ends.compression, stable_stretch),
          last_stable(0, search_ends.shear, [&](double amount) { return stable(simple_shear(amount)); })};
}

} // namespace springproof::msm
