// The readers of comma-separated values as a target for libFuzzer: displacements and measured curves.

#include "msm/design/uniaxial.hpp"
#include "tests/fuzz/displacements.hpp"

#include <cmath>

using namespace springproof;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  fuzz::read_and_match(compare::read_displacement_csv, bytes, size);
  try {
    const msm::UniaxialCurve curve = msm::read_curve({reinterpret_cast<const char*>(bytes), size}, "curve");
    PROMISE(curve.axial_strain.size() >= 2);
    for (const auto* column : {&curve.axial_strain, &curve.stress, &curve.lateral_strain}) {
      PROMISE(column->size() == curve.axial_strain.size());
      for (const double value : *column) PROMISE(std::isfinite(value));
    }
  } catch (const cases::InputError&) {
    // what wrong input is answered with
  }
  return 0;
}
