#include "mechanics/contact/signed_distance.hpp"

#include "tests/support/tool_surfaces.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>

using namespace springproof;

using cases::tools::Kind;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using mechanics::SignedDistance;

namespace {

const Vector3d askew = Vector3d(1, 2, -2) / 3;

/// A ball of radius 2 with bumps and hollows.
cases::Surface bumpy() {
  cases::Surface surface = tool_surfaces::ball(2, 6);
  for (auto& triangle : surface)
    for (Vector3d& at : triangle)
      at *= 1 + 0.4 * std::sin(2.1 * at.x() + 1) * std::cos(1.7 * at.y() - at.z());
  return surface;
}

const Kind shapes[] = {cases::tools::Sphere{2},
                       cases::tools::Cylinder{2, askew},
                       cases::tools::Punch{2, askew},
                       cases::tools::Plane{askew},
                       tool_surfaces::tool(tool_surfaces::box({-1, -1, -1}, {1, 2, 1.5})),
                       tool_surfaces::tool(bumpy())};

SignedDistance signed_distance(const Kind& shape, const Vector3d& at) {
  return mechanics::distance_from(shape)(at);
}

/// The same by all triangles: the nearest place solves a least-squares problem of its inside, its edges or
/// its corners; a point is inside where the triangles' solid angles add up to a sphere's (A. van Oosterom and
/// J. Strackee, IEEE Transactions on Biomedical Engineering 30, 1983).
double brute_force(const cases::Surface& surface, const Vector3d& at) {
  double nearest = INFINITY, angle = 0;
  for (const auto& [a, b, c] : surface) {
    Eigen::Matrix<double, 3, 2> sides;
    sides << b - a, c - a;
    const Eigen::Vector2d in = sides.colPivHouseholderQr().solve(at - a);
    if (in.minCoeff() >= 0 && in.sum() <= 1) nearest = std::min(nearest, (a + sides * in - at).norm());
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      const double along = (at - from).dot(to - from) / (to - from).squaredNorm();
      nearest = std::min(nearest, (from + std::clamp(along, 0., 1.) * (to - from) - at).norm());
    }
    const Vector3d p = a - at, q = b - at, r = c - at;
    angle += 2 * std::atan2(p.dot(q.cross(r)), p.norm() * q.norm() * r.norm() + p.dot(q) * r.norm() +
                                                   q.dot(r) * p.norm() + r.dot(p) * q.norm());
  }
  return angle > 2 * std::acos(-1.) ? -nearest : nearest;
}

} // namespace

TEST_CASE("distances from tools are those of geometry") {
  CHECK(signed_distance(cases::tools::Sphere{2}, {0, 3, 4}).value == Approx(3));
  CHECK(signed_distance(cases::tools::Sphere{2}, {0, 1, 0}).value == Approx(-1));
  CHECK(signed_distance(cases::tools::Cylinder{2, Vector3d::UnitZ()}, {3, 4, 100}).value == Approx(3));
  CHECK(signed_distance(cases::tools::Plane{Vector3d::UnitY()}, {7, -0.5, 3}).value == Approx(-0.5));
  const cases::tools::Punch punch{2, -Vector3d::UnitZ()};
  CHECK(signed_distance(punch, {1, 0, -3}).value == Approx(3));           // before the flat end
  CHECK(signed_distance(punch, {1, 0, 0.5}).value == Approx(-0.5));       // behind it
  CHECK(signed_distance(punch, {1.75, 0, 0.5}).value == Approx(-0.25));   // nearer to the side
  CHECK(signed_distance(punch, {0, 5, 0.5}).value == Approx(3));          // beside it
  CHECK(signed_distance(punch, {5, 0, -4}).value == Approx(5));           // off the edge
  CHECK(signed_distance(punch, {2, 0, 0.5}).normal == Vector3d::UnitX()); // on the edge: beside
}

TEST_CASE("normals and curvatures are the derivatives of distances") {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> any(-3, 3);
  constexpr double h = 1e-5; // central differences then err by about h² = 1e-10
  for (const Kind& shape : shapes) {
    const auto distance = mechanics::distance_from(shape);
    for (int n = 0; n < 40; ++n) {
      const Vector3d at(any(generator), any(generator), any(generator));
      const auto here = distance(at);
      CHECK(here.normal.norm() == Approx(1).epsilon(1e-12));
      Vector3d gradient;
      Matrix3d curvature;
      for (int c = 0; c < 3; ++c) {
        const auto ahead = distance(at + h * Vector3d::Unit(c)),
                   behind = distance(at - h * Vector3d::Unit(c));
        gradient[c] = (ahead.value - behind.value) / (2 * h);
        curvature.col(c) = (ahead.normal - behind.normal) / (2 * h);
      }
      INFO(cases::name_of(shape) << " at " << at.transpose());
      CHECK((gradient - here.normal).norm() < 1e-7);
      CHECK((curvature - here.curvature).norm() < 1e-7);
    }
  }
}

TEST_CASE("a point near the edges and corners of a hollow surface is on the side that all triangles say") {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> any(-1, 1);
  const cases::Surface surface = bumpy();
  const auto distance = mechanics::distance_from(tool_surfaces::tool(surface));
  int n_inside = 0;
  for (const auto& [a, b, c] : surface)
    for (const double away : {1., 1e-3, 1e-6})
      for (const Vector3d& place : {a, Vector3d(0.3 * a + 0.7 * b), Vector3d((a + b + c) / 3)}) {
        const Vector3d at = place + away * Vector3d(any(generator), any(generator), any(generator));
        const double expected = brute_force(surface, at), found = distance(at).value;
        n_inside += found < 0;
        if (std::abs(found - expected) <= 1e-12) continue;
        INFO("at " << at.transpose());
        CHECK(found == expected);
      }
  CHECK(n_inside > 800); // there are 2592
}

TEST_CASE("a cube bends distances by its edges and corners alone") {
  const auto distance =
      mechanics::distance_from(tool_surfaces::tool(tool_surfaces::box({-1, -1, -1}, {1, 1, 1})));
  const auto check = [&](const Vector3d& at, double value, const Vector3d& normal) {
    const SignedDistance found = distance(at);
    INFO(at.transpose());
    CHECK(found.value == Approx(value).margin(1e-15));
    CHECK((found.normal - normal).norm() < 1e-15);
    CHECK(found.curvature.norm() < 1e-12);
  };
  const Vector3d up(0, 0, 1);
  check({0.3, 0.1, 1.5}, 0.5, up);
  check({0.5, 0.5, 1.5}, 0.5, up);  // over the edge of two triangles, or
  check({0.5, -0.5, 1.5}, 0.5, up); // the other way
  check({1, 0.2, 1.5}, 0.5, up);    // over the rim
  check({1, 1, 1.5}, 0.5, up);      // over a corner
  check({0.3, 0.1, 0.75}, -0.25, up);
  check({0.5, 0.5, 1}, 0, up); // on the surface
  const double root = std::sqrt(0.5);
  const SignedDistance beside = distance({0.2, 2, 2}), off = distance({2, 2, 2}),
                       at_rim = distance({0.2, 1, 1});
  CHECK(beside.value == Approx(std::sqrt(2.)));
  CHECK(beside.curvature.trace() == Approx(root));
  CHECK((beside.curvature * Vector3d::UnitX()).norm() < 1e-12);
  CHECK(off.value == Approx(std::sqrt(3.)));
  CHECK(off.curvature.trace() == Approx(2 / std::sqrt(3.)));
  CHECK(std::abs(at_rim.value) < 1e-15);
  CHECK((at_rim.normal - Vector3d(0, root, root)).norm() < 1e-12);
  CHECK(at_rim.curvature.isZero(0));
}
