#include "fem_reference/laws/formulation.hpp"

#include "fem_reference/law_kernel.hpp"
#include "fem_reference/laws/in_principal_stretches.hpp"
#include "fem_reference/laws/saint_venant_kirchhoff.hpp"
#include "fem_reference/laws/small_strain.hpp"
#include "fem_reference/laws/transverse_log_strain.hpp"
#include "fem_reference/laws/transverse_small_strain.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/ogden.hpp"

#include <array>

namespace springproof::fem_reference {

namespace {

template<class Law>
std::optional<Formulation> with_law(const cases::Material& material) {
  const auto* own = std::get_if<typename Law::Material>(&material);
  if (own == nullptr) return std::nullopt;
  return Formulation{{Law::traits}, [law = Law(*own)](const ElementType& element) {
                       return std::make_unique<LawKernel<Law>>(element, law);
                     }};
}

struct Row {
  cases::Formulation name;
  const char* model; ///< of the material, as in case files
  std::optional<Formulation> (*make)(const cases::Material& material);
};

/// Every law: its file is in this folder, or in mechanics/laws when springs are designed with it too.
constexpr std::array<Row, 6> registry{
    {{cases::Formulation::small_strain, "linear_elastic", with_law<SmallStrain>},
     {cases::Formulation::small_strain, "transversely_isotropic", with_law<TransverseSmallStrain>},
     {cases::Formulation::saint_venant_kirchhoff, "linear_elastic", with_law<SaintVenantKirchhoff>},
     {cases::Formulation::log_strain, "linear_elastic", with_law<InPrincipalStretches<mechanics::LogStrain>>},
     {cases::Formulation::log_strain, "transversely_isotropic", with_law<TransverseLogStrain>},
     {cases::Formulation::hyperelastic, "ogden", with_law<InPrincipalStretches<mechanics::Ogden>>}}};

} // namespace

Formulation make_formulation(const cases::Fem& fem, const cases::Material& material) {
  std::vector<std::string> models;
  for (const Row& row : registry) {
    if (row.name != fem.formulation) continue;
    if (auto formulation = row.make(material)) return std::move(*formulation);
    models.emplace_back(row.model);
  }
  throw cases::InputError(fem.where,
                          "this formulation needs material.model = " + cases::alternatives(models));
}

} // namespace springproof::fem_reference
