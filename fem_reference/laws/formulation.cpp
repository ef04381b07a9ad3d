#include "fem_reference/laws/formulation.hpp"

#include "fem_reference/law_kernel.hpp"
#include "fem_reference/laws/in_principal_stretches.hpp"
#include "fem_reference/laws/saint_venant_kirchhoff.hpp"
#include "fem_reference/laws/small_strain.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/ogden.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace springproof::fem_reference {

namespace {

template<class Law>
Formulation with_law(const cases::Fem& fem, const cases::Material& material) {
  const auto* own = std::get_if<typename Law::Material>(&material);
  if (own == nullptr)
    throw cases::InputError(
        fem.where, std::string("this formulation needs material.model = \"") +
                       (std::is_same_v<typename Law::Material, cases::Ogden> ? "ogden" : "linear_elastic") +
                       "\"");
  return {{Law::traits}, [law = Law(*own)](const ElementType& element) {
            return std::make_unique<LawKernel<Law>>(element, law);
          }};
}

struct Row {
  cases::Formulation name;
  Formulation (*make)(const cases::Fem& fem, const cases::Material& material);
};

/// Every law: its file is in this folder, or in mechanics/laws when springs are designed with it too.
constexpr std::array<Row, 4> registry{
    {{cases::Formulation::small_strain, with_law<SmallStrain>},
     {cases::Formulation::saint_venant_kirchhoff, with_law<SaintVenantKirchhoff>},
     {cases::Formulation::log_strain, with_law<InPrincipalStretches<mechanics::LogStrain>>},
     {cases::Formulation::hyperelastic, with_law<InPrincipalStretches<mechanics::Ogden>>}}};

} // namespace

Formulation make_formulation(const cases::Fem& fem, const cases::Material& material) {
  const auto row =
      std::find_if(registry.begin(), registry.end(), [&](const Row& r) { return r.name == fem.formulation; });
  assert(row != registry.end());
  return row->make(fem, material);
}

} // namespace springproof::fem_reference
