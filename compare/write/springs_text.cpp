#include "compare/write/springs_text.hpp"

#include <array>
#include <fmt/format.h>
#include <map>

namespace springproof::compare {

namespace {

std::string cell_text(const msm::CellTerms& terms) {
  const std::array<std::string, 3> kind_names{"edges", "face diagonals", "internal diagonals"};
  std::map<std::pair<int, std::string>, int> n_of; // springs of one kind and stiffness, as printed
  std::vector<std::string> parts;
  for (const msm::CellSpring& spring : terms.springs)
    ++n_of[{msm::n_axes(spring), fmt::format("{:.4g} N/m", 1e3 * spring.stiffness)}];
  for (const auto& [spring, n] : n_of)
    parts.push_back(
        fmt::format("{} {} of {}", n, kind_names[static_cast<std::size_t>(spring.first - 1)], spring.second));
  if (!terms.tetrahedra.empty())
    parts.push_back(fmt::format("{} tetrahedra of biquadratic springs", terms.tetrahedra.size()));
  if (terms.volume != 0) parts.push_back(fmt::format("k_v = {:.4g} MPa", terms.volume));
  return fmt::format("{} in a cell", fmt::join(parts, ", "));
}

nlohmann::ordered_json cell_to_json(const msm::BodyTerms& terms) {
  const msm::CellTerms& cell = terms.kinds.front();
  nlohmann::ordered_json springs = nlohmann::ordered_json::array(), tetrahedra = springs;
  for (const msm::CellSpring& spring : cell.springs) {
    springs.push_back({{"vertices", spring.vertices}, {"stiffness_N_per_m", 1e3 * spring.stiffness}});
    if (const char* name = msm::parameter_name(spring.law.kind)) springs.back()[name] = spring.law.parameter;
  }
  for (const msm::CellTetrahedron& tetrahedron : cell.tetrahedra)
    tetrahedra.push_back(
        {{"vertices", tetrahedron.vertices}, {"lambda_MPa", tetrahedron.lambda}, {"mu_MPa", tetrahedron.mu}});
  return {{"springs", springs},
          {"tetrahedra", tetrahedra},
          {"mirrored_from_cell_to_cell", terms.kinds.size() > 1},
          {"boundary", cases::name_of(terms.boundary)}};
}

} // namespace

std::string springs_text(const msm::DesignResult& design) {
  if (design.springs.network()) return "of the case's file";
  const msm::BodyTerms* terms = design.springs.terms();
  if (terms && terms->boundary == msm::Boundary::whole)
    return fmt::format("every spring {:.4g} N/m", 1e3 * design.stiffness.internal_diagonal);
  const msm::CellStiffness& k = design.stiffness;
  const std::string exponents = k.exponents
                                    ? fmt::format(", exponents {:.4g}, {:.4g}, {:.4g}", k.exponents->edge,
                                                  k.exponents->face_diagonal, k.exponents->internal_diagonal)
                                    : "";
  if (terms) return cell_text(terms->kinds.front()) + exponents;
  std::string text = fmt::format("k_e, k_f, k_d = {:.4g}, {:.4g}, {:.4g} N/m", 1e3 * k.edge,
                                 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal);
  if (k.volume != 0) text += fmt::format(", k_v = {:.4g} MPa", k.volume);
  return text + exponents;
}

nlohmann::ordered_json springs_to_json(const msm::DesignResult& design) {
  const msm::CellStiffness& k = design.stiffness;
  nlohmann::ordered_json springs{{"stiffness_N_per_m", nullptr}, {"volume_stiffness_MPa", k.volume}};
  if (design.springs.cells())
    springs["stiffness_N_per_m"] = {1e3 * k.edge, 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal};
  if (k.exponents)
    springs["exponents"] = {k.exponents->edge, k.exponents->face_diagonal, k.exponents->internal_diagonal};
  if (const msm::BodyTerms* terms = design.springs.terms()) {
    springs["volume_stiffness_MPa"] = terms->kinds.front().volume;
    springs["cell"] = cell_to_json(*terms);
  }
  return springs;
}

} // namespace springproof::compare
