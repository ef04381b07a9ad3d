#include "msm/design/patch.hpp"

#include "mechanics/dense.hpp"
#include "msm/direct/factorisation.hpp"

#include <Eigen/QR>
#include <cmath>
#include <numeric>
#include <random>

namespace springproof::msm {

using cases::index;
using Eigen::Vector3d;
using mechanics::Vector;

namespace {

/// u = e x at a point, columns by unit engineering strains xx, yy, zz, yz, xz, xy.
Eigen::Matrix<double, 3, 6> strained(const Vector3d& x) {
  Eigen::Matrix<double, 3, 6> u;
  u << x.x(), 0, 0, 0, x.z() / 2, x.y() / 2, //
      0, x.y(), 0, x.z() / 2, 0, x.x() / 2,  //
      0, 0, x.z(), x.y() / 2, x.x() / 2, 0;
  return u;
}

/// The shift, over the mean of the diagonal, with which points that no spring holds are factorised too. They
/// have no forces under uniform strains.
constexpr double small_shift = 1e-10;

/// A point moves if its motion is larger than this, over the largest; rounding leaves 1e-8 of others.
constexpr double moves = 1e-4;

/// The points that move, seen from most of the points: three of them are taken at random, again and again,
/// and the rigid motions that these three have are left out of all. The three from which fewest points move
/// are kept (Fischler & Bolles 1981). Few points that swing far from the others would turn least squares.
/// @param rigid  six columns, as motions: degree of freedom 3*point + component
std::vector<int> moving_points(const Eigen::MatrixXd& rigid, const Eigen::MatrixXd& motions) {
  constexpr int n_trials = 100;
  const Eigen::Index n_points = rigid.rows() / 3;
  std::vector<int> fewest(index(n_points));
  std::iota(fewest.begin(), fewest.end(), 0);
  std::mt19937 generator;
  for (int trial = 0; trial < n_trials; ++trial) {
    std::vector<Eigen::Index> dofs;
    for (int corner = 0; corner < 3; ++corner) {
      const auto point = static_cast<Eigen::Index>(generator() % index(n_points));
      for (Eigen::Index c = 0; c < 3; ++c) dofs.push_back(3 * point + c);
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(rigid(dofs, Eigen::all));
    if (factors.rank() < 6) continue; // they are on a line
    const Eigen::MatrixXd rest = motions - rigid * factors.solve(motions(dofs, Eigen::all));
    Vector sizes(n_points);
    for (Eigen::Index p = 0; p < n_points; ++p) sizes[p] = rest.middleRows<3>(3 * p).norm();
    std::vector<int> moving;
    for (Eigen::Index p = 0; p < n_points; ++p)
      if (sizes[p] > moves * sizes.maxCoeff()) moving.push_back(static_cast<int>(p));
    if (moving.size() < fewest.size()) fewest = moving;
  }
  return fewest;
}

} // namespace

Elasticity spring_elasticity(const Vector3d& d, double stiffness) {
  Eigen::Matrix<double, 6, 1> m;
  m << d.cwiseProduct(d), d.y() * d.z(), d.x() * d.z(), d.x() * d.y();
  return stiffness / d.squaredNorm() * m * m.transpose();
}

Elasticity cell_elasticity(const CellTerms& terms, const cases::CellCorners& corners) {
  const double volume = cases::cell_volume(corners);
  Elasticity sum = Elasticity::Zero();
  const auto add = [&](const Vector3d& d, double stiffness) {
    sum += spring_elasticity(d, stiffness) / volume;
  };
  for (const CellSpring& spring : terms.springs)
    add(corners[index(spring.vertices[1])] - corners[index(spring.vertices[0])], spring.stiffness);
  for (const CellMidline& line : terms.midlines) {
    Vector3d between = Vector3d::Zero();
    for (std::size_t v = 0; v < 8; ++v) between += ((v >> line.axis & 1U) != 0 ? 0.25 : -0.25) * corners[v];
    add(between, line.stiffness);
  }
  sum.topLeftCorner<3, 3>().array() += terms.volume;
  for (const CellTetrahedron& tetrahedron : terms.tetrahedra) {
    sum.topLeftCorner<3, 3>().array() += tetrahedron.lambda;
    sum.diagonal().head<3>().array() += 2 * tetrahedron.mu;
    sum.diagonal().tail<3>().array() += tetrahedron.mu;
  }
  return sum;
}

double strain_misfit(const Elasticity& lattice, const Elasticity& material) {
  // The norm belongs to tensors: by Mandel's components, in which shears count √2 times the engineering ones.
  Eigen::Matrix<double, 6, 1> weights;
  weights << Vector3d::Ones(), Vector3d::Constant(std::sqrt(2.));
  const auto mandel = [&](const Elasticity& c) -> Elasticity {
    return weights.asDiagonal() * c * weights.asDiagonal();
  };
  const Elasticity root = mechanics::inverse_square_root(mandel(material));
  return (root * mandel(lattice - material) * root).norm() / std::sqrt(6.);
}

Relaxation relax(const Lattice& lattice, const std::vector<bool>& is_free, double volume) {
  std::vector<bool> is_held;
  for (const bool free : is_free) is_held.insert(is_held.end(), 3, !free);
  Tangent tangent(lattice, is_held);
  if (tangent.n_free() == 0) return {};
  const Tangent::Matrix& matrix = tangent.assemble(lattice.rest, Clamp::no);
  const std::vector<int>& number = tangent.free_number();
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(tangent.n_free(), 6);
  const auto add = [&](int at, const Eigen::Matrix<double, 3, 6>& force) {
    if (number[index(3 * at)] >= 0) forces.middleRows<3>(number[index(3 * at)]) += force;
  };
  visit_tangent_blocks(lattice, lattice.rest, Clamp::no,
                       [&](int row, int column, const Eigen::Matrix3d& block) {
                         add(row, block * strained(lattice.rest[index(column)]));
                         if (row != column)
                           add(column, block.transpose() * strained(lattice.rest[index(row)]));
                       });
  const OneThread one;
  Factorisation factors;
  factors.analyse(matrix);
  if (!factors.factorise(matrix, 0) &&
      !factors.factorise(matrix, small_shift * matrix.diagonal().cwiseAbs().mean()))
    return {Elasticity::Zero(), false};
  Relaxation relaxation;
  for (int strain = 0; strain < 6; ++strain)
    relaxation.released.col(strain) = forces.transpose() * factors.solve(forces.col(strain)) / volume;
  return relaxation;
}

Eigen::SparseMatrix<double> free_stiffness(const Lattice& lattice) {
  Tangent tangent(lattice, std::vector<bool>(3 * lattice.rest.size(), false));
  return tangent.assemble(lattice.rest, Clamp::no).selfadjointView<Eigen::Lower>();
}

ZeroModes zero_modes(const Points& points, const Eigen::MatrixXd& null_space) {
  const auto n_points = static_cast<Eigen::Index>(points.size());
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& point : points) centre += point / static_cast<double>(n_points);
  double size = 0;
  for (const Vector3d& point : points) size = std::max(size, (point - centre).norm());
  Eigen::MatrixXd rigid(3 * n_points, 6);
  for (Eigen::Index p = 0; p < n_points; ++p) {
    const Vector3d x = (points[index(p)] - centre) / (size > 0 ? size : 1);
    rigid.middleRows<3>(3 * p) << 1, 0, 0, 0, x.z(), -x.y(), //
        0, 1, 0, -x.z(), 0, x.x(),                           //
        0, 0, 1, x.y(), -x.x(), 0;
  }
  ZeroModes found;
  found.n = static_cast<int>(null_space.cols() -
                             Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(rigid).rank()); // 5 of a line
  if (found.n <= 0) return found;
  found.nodes = moving_points(rigid, null_space);
  return found;
}

} // namespace springproof::msm
