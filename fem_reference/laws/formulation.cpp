#include "fem_reference/laws/formulation.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace springproof::fem_reference {

namespace {

template<typename Wanted>
const Wanted& material_as(const cases::Fem& fem, const cases::Material& material, const char* wanted) {
  if (const auto* found = std::get_if<Wanted>(&material)) return *found;
  throw cases::InputError(fem.where,
                          std::string("this formulation needs material.model = \"") + wanted + "\"");
}

} // namespace

ElasticModuli elastic_moduli(const cases::LinearElastic& material) {
  const double young = material.youngs_modulus, poisson = material.poissons_ratio;
  const double mu = young / (2 * (1 + poisson));
  const double lambda = 2 * mu * poisson / (1 - 2 * poisson);
  return {lambda, mu, lambda + 2 * mu / 3};
}

Formulation make_formulation(const cases::Fem& fem, const cases::Material& material) {
  const auto linear = [&] { return material_as<cases::LinearElastic>(fem, material, "linear_elastic"); };
  switch (fem.formulation) {
  case cases::Formulation::small_strain:
    return small_strain(linear());
  case cases::Formulation::saint_venant_kirchhoff:
    return saint_venant_kirchhoff(linear());
  case cases::Formulation::log_strain:
    return log_strain(linear());
  case cases::Formulation::hyperelastic:
    return ogden(material_as<cases::Ogden>(fem, material, "ogden"));
  }
  throw cases::InputError(fem.where, "unknown formulation");
}

double volume_ratio(Kinematics kinematics, const Matrix3& f) {
  return kinematics == Kinematics::linear ? f.trace() - 2 : f.determinant();
}

Matrix3 cofactor(Kinematics kinematics, const Matrix3& f) {
  if (kinematics == Kinematics::linear) return Matrix3::Identity();
  Matrix3 result;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d row = f.row((i + 1) % 3).cross(f.row((i + 2) % 3));
    result.row(i) = row.transpose();
  }
  return result;
}

void add_cofactor_derivative(Kinematics kinematics, const Matrix3& f, double factor, Matrix9& tangent) {
  if (kinematics == Kinematics::linear) return;
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3, m = (i + 2) % 3; // eps_ikm = 1, eps_imk = -1
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      tangent(3 * i + a, 3 * k + b) += factor * f(m, c);
      tangent(3 * i + a, 3 * k + c) -= factor * f(m, b);
      tangent(3 * i + a, 3 * m + b) -= factor * f(k, c);
      tangent(3 * i + a, 3 * m + c) += factor * f(k, b);
    }
  }
}

} // namespace springproof::fem_reference
