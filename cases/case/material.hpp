#pragma once

#include "cases/case/body.hpp"
#include "cases/case/dynamics.hpp"

#include <cmath>
#include <numeric>

/// [material] and [[region_material]] of a case file. Units: MPa, mm.
namespace springproof::cases {

struct LinearElastic {
  static constexpr const char* name = "linear_elastic"; ///< in case files
  double youngs_modulus;                                ///< MPa, > 0
  double poissons_ratio;                                ///< in (-1, 0.5)
};
SPRINGPROOF_FIELDS(LinearElastic, youngs_modulus, poissons_ratio)

/// W = sum_i 2 mu_i/alpha_i² (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3) + kappa/4 (J² - 1 - 2 ln J), where
/// l1, l2, l3 are the isochoric stretches. Neo-Hookean: alpha = 2; Mooney-Rivlin: alpha = 2, -2.
struct Ogden {
  static constexpr const char* name = "ogden";
  std::vector<double> mu;             ///< MPa; the sum is the initial shear modulus, > 0
  std::vector<double> alpha;          ///< as many, none 0
  std::optional<double> bulk_modulus; ///< MPa; absent: nearly incompressible
};
SPRINGPROOF_FIELDS(Ogden, mu, alpha, bulk_modulus)

/// W = c10 I + c20 I² + c30 I³ + kappa/4 (J² - 1 - 2 ln J), I = l1² + l2² + l3² - 3 of isochoric stretches.
/// Source: Yeoh 1993, Rubber Chem Technol 66:754.
struct Yeoh {
  static constexpr const char* name = "yeoh";
  double c10;                         ///< MPa, > 0: half the initial shear modulus
  double c20 = 0, c30 = 0;            ///< MPa
  std::optional<double> bulk_modulus; ///< MPa; absent: nearly incompressible
};
SPRINGPROOF_FIELDS(Yeoh, c10, c20, c30, bulk_modulus)

/// Linear elastic with an axis of symmetry, its fibre: engineering constants along and across it. The strain
/// energy is positive when poissons_ratio_along² < (1 - poissons_ratio_across) E_along/(2 E_across).
struct TransverselyIsotropic {
  static constexpr const char* name = "transversely_isotropic";
  double youngs_modulus_along, youngs_modulus_across; ///< E_L, E_T, MPa, > 0
  double poissons_ratio_along;  ///< nu_LT: contraction across the fibre, pulled along it
  double poissons_ratio_across; ///< nu_TT in (-1, 1): contraction across the fibre, pulled across it
  double shear_modulus_along;   ///< G_LT, MPa, > 0: between the fibre and a direction across it
  Eigen::Vector3d fibre = Eigen::Vector3d::UnitX(); ///< unit length
};
SPRINGPROOF_FIELDS(TransverselyIsotropic, youngs_modulus_along, youngs_modulus_across, poissons_ratio_along,
                   poissons_ratio_across, shear_modulus_along, fibre)

using Material = std::variant<LinearElastic, Ogden, TransverselyIsotropic, Yeoh>;

/// Moduli at rest of a hyperelastic material, MPa.
struct HyperelasticRest {
  double shear_modulus;
  std::optional<double> bulk_modulus; ///< absent: nearly incompressible
};
inline HyperelasticRest at_rest(const Ogden& m) {
  return {std::accumulate(m.mu.begin(), m.mu.end(), 0.), m.bulk_modulus};
}
inline HyperelasticRest at_rest(const Yeoh& m) {
  return {2 * m.c10, m.bulk_modulus};
}

/// Those of a material that is hyperelastic; else nothing.
inline std::optional<HyperelasticRest> hyperelastic_rest(const Material& material) {
  return std::visit(
      [](const auto& m) -> std::optional<HyperelasticRest> {
        using Kind = std::decay_t<decltype(m)>;
        if constexpr (std::is_same_v<Kind, LinearElastic> || std::is_same_v<Kind, TransverselyIsotropic>)
          return std::nullopt;
        else
          return at_rest(m); // a law without one must not compile
      },
      material);
}

inline bool is_hyperelastic(const Material& material) {
  return hyperelastic_rest(material).has_value();
}

/// The axis along which a direction lies, to 1e-9 of its length; none when it lies askew.
inline std::optional<Axis> axis_along(const Eigen::Vector3d& direction) {
  int axis = 0;
  const double along = direction.cwiseAbs().maxCoeff(&axis);
  Eigen::Vector3d across = direction;
  across[axis] = 0;
  if (across.norm() > 1e-9 * along) return std::nullopt;
  return static_cast<Axis>(axis);
}

inline bool is_isotropic(const Material& material) {
  return !std::holds_alternative<TransverselyIsotropic>(material);
}

/// Poisson's ratio at rest of an isotropic material.
inline double poissons_ratio_of(const Material& material) {
  if (const auto* linear = std::get_if<LinearElastic>(&material)) return linear->poissons_ratio;
  const HyperelasticRest rest = hyperelastic_rest(material).value();
  if (!rest.bulk_modulus) return 0.5;
  const double mu = rest.shear_modulus, kappa = *rest.bulk_modulus;
  return (3 * kappa - 2 * mu) / (2 * (3 * kappa + mu));
}

/// A material for a part of the body, in place of the body's own. The part is the cells of a physical group,
/// or those whose centre lies in a box.
struct RegionMaterial {
  Material material;                                            ///< the same model as the body's own
  std::string group;                                            ///< empty: the box
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(-INFINITY); ///< mm; infinite where the box has no end
  Eigen::Vector3d upper = -lower;
  Where where;
  MaterialDynamics dynamics{};
};
SPRINGPROOF_FIELDS(RegionMaterial, material, group, lower, upper, where, dynamics)

} // namespace springproof::cases
