#pragma once

#include "fem_reference/laws/point.hpp"
#include "fem_reference/laws/transverse_log_strain.hpp"
#include "fem_reference/laws/transverse_small_strain.hpp"

#include <functional>

using namespace springproof;

/// Laws at a point, without an element around them.
namespace point_laws {

using namespace fem_reference;

/// A law with its type left behind.
struct PointLaw : LawTraits {
  std::function<void(const Matrix3& f, Wanted wanted, PointStress& result)> stress;
  std::function<double(const Matrix3& f)> energy;            ///< the pressure's included
  std::function<ValueAndSlope(double)> pressure, dilatation; ///< none without a pressure of its own
};

template<class Law>
PointLaw point_law(const typename Law::Material& material) {
  const Law l(material);
  PointLaw result{
      {Law::traits},
      [l](const Matrix3& f, Wanted w, PointStress& p) { l.stress(f - Matrix3::Identity(), w, p); },
      [l](const Matrix3& f) { return l.energy(f - Matrix3::Identity()); },
      {},
      {}};
  if constexpr (Law::traits.split == Split::pressure) {
    result.energy = [l](const Matrix3& f) {
      const Matrix3 h = f - Matrix3::Identity();
      return l.energy(h) + l.volume_energy(dilatation(Law::traits.kinematics, h));
    };
    result.pressure = [l](double change) { return l.pressure(change); };
    result.dilatation = [l](double p) { return l.dilatation(p); };
  }
  return result;
}

/// P with the pressure p(J) pointwise.
inline Vector9 whole_stress(const PointLaw& law, const Matrix3& f) {
  PointStress point;
  law.stress(f, Wanted::stress, point);
  if (law.pressure)
    point.stress += law.pressure(dilatation(law.kinematics, f - Matrix3::Identity())).value *
                    flatten(cofactor(law.kinematics, f));
  return point.stress;
}

inline Matrix9 whole_tangent(const PointLaw& law, const Matrix3& f) {
  PointStress point;
  law.stress(f, Wanted::stress_and_tangent, point);
  if (law.pressure) {
    const ValueAndSlope p = law.pressure(dilatation(law.kinematics, f - Matrix3::Identity()));
    const Vector9 area = flatten(cofactor(law.kinematics, f));
    add_cofactor_derivative(law.kinematics, f, p.value, point.tangent);
    point.tangent += p.slope * area * area.transpose();
  }
  return point.tangent;
}

} // namespace point_laws
