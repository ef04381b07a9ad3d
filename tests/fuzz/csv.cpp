// The readers of comma-separated values as a target for libFuzzer: displacements, measured curves, spring
// networks and their nodes, and recordings of pulls.

#include "cases/scene/scene.hpp"
#include "compare/interact/recording.hpp"
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
  try {
    constexpr std::size_t n_nodes = 8;
    const auto springs =
        cases::read_network({reinterpret_cast<const char*>(bytes), size}, "network", n_nodes);
    PROMISE(!springs.empty());
    for (const cases::NetworkSpring& spring : springs) {
      PROMISE(0 <= spring.a && spring.a < static_cast<int>(n_nodes) && spring.a != spring.b);
      PROMISE(0 <= spring.b && spring.b < static_cast<int>(n_nodes));
      PROMISE(std::isfinite(spring.stiffness) && spring.stiffness >= 0); // what is below 1e-308 is 0
      PROMISE(!spring.rest_length || (std::isfinite(*spring.rest_length) && *spring.rest_length > 0));
      PROMISE(!spring.exponent || std::abs(*spring.exponent) <= 20);
    }
  } catch (const cases::InputError&) {
    // the same
  }
  try {
    const cases::NetworkNodes nodes =
        cases::read_nodes({reinterpret_cast<const char*>(bytes), size}, "nodes");
    PROMISE(!nodes.places.empty() && (nodes.masses.empty() || nodes.masses.size() == nodes.places.size()));
    for (const Eigen::Vector3d& place : nodes.places) PROMISE(place.allFinite());
    for (const double mass : nodes.masses) PROMISE(std::isfinite(mass) && mass > 0);
  } catch (const cases::InputError&) {
    // the same
  }
  try {
    constexpr double step = 0.01, end = 10;
    long last = 0;
    for (const compare::Hold& hold :
         compare::read_recording({reinterpret_cast<const char*>(bytes), size}, "pulls", step, end)) {
      PROMISE(hold.centre.allFinite() && hold.radius >= 0 && !hold.force.empty());
      for (const Eigen::Vector3d& force : hold.force) PROMISE(force.allFinite());
      PROMISE(hold.first_step > last);
      last = hold.first_step + static_cast<long>(hold.force.size()) - 1;
      PROMISE(static_cast<double>(last) * step <= end * (1 + 1e-9));
    }
  } catch (const cases::InputError&) {
    // the same
  }
  return 0;
}
