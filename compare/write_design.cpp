#include "compare/write_design.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <nlohmann/json.hpp>

namespace compare {

using Json = nlohmann::ordered_json;

namespace {

Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

} // namespace

void write_design_text(std::ostream& out, const std::string& method, const msm::DesignResult& design) {
  const msm::CellStiffness& k = design.stiffness;
  const msm::LatticeModuli& m = design.moduli;
  fmt::print(out, "{}\n  k_e, k_f, k_d    {:.6g}, {:.6g}, {:.6g} N/m\n", method, 1e3 * k.edge,
             1e3 * k.face_diagonal, 1e3 * k.internal_diagonal);
  if (k.volume != 0) fmt::print(out, "  k_v              {:.6g} MPa\n", k.volume);
  if (design.residual) fmt::print(out, "  residual         {:.6g}\n", *design.residual);
  fmt::print(out, "  lattice          C11 {:.6g}, C12 {:.6g}, C44 {:.6g} MPa, Zener ratio {:.4f}\n", m.c11,
             m.c12, m.c44, m.zener);
  fmt::print(out, "  along its axes   E {:.6g} MPa, nu {:.4f}, G {:.6g} MPa\n", m.youngs_modulus,
             m.poissons_ratio, m.shear_modulus);
  for (const std::string& warning : design.warnings) fmt::print(out, "  WARNING: {}\n", warning);
}

Json moduli_to_json(const msm::LatticeModuli& moduli) {
  return {{"C11", finite_or_null(moduli.c11)},
          {"C12", finite_or_null(moduli.c12)},
          {"C44", finite_or_null(moduli.c44)},
          {"zener", finite_or_null(moduli.zener)},
          {"youngs_modulus", finite_or_null(moduli.youngs_modulus)},
          {"poissons_ratio", finite_or_null(moduli.poissons_ratio)},
          {"shear_modulus", finite_or_null(moduli.shear_modulus)}};
}

Json design_to_json(const std::string& method, const msm::DesignResult& design) {
  const msm::CellStiffness& k = design.stiffness;
  return {{"method", method},
          {"stiffness_N_per_m", {1e3 * k.edge, 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal}},
          {"volume_stiffness_MPa", k.volume},
          {"residual", design.residual ? finite_or_null(*design.residual) : Json(nullptr)},
          {"moduli", moduli_to_json(design.moduli)},
          {"warnings", design.warnings}};
}

} // namespace compare
