#include "fem_reference/laws/formulation.hpp"

#include "fem_reference/law_kernel.hpp"
#include "fem_reference/laws/transverse_log_strain.hpp"
#include "fem_reference/laws/transverse_small_strain.hpp"

namespace springproof::fem_reference {

namespace {

/// Returns the formulation by the one of these laws that takes this material.
template<class Law, class... Others>
Formulation with_material(const cases::Fem& fem, const cases::Material& material,
                          std::vector<std::string> models = {}) {
  using Material = typename Law::Material;
  if (const auto* own = std::get_if<Material>(&material))
    return {{Law::traits}, [law = Law(*own)](const ElementType& element) {
              return std::make_unique<LawKernel<Law>>(element, law);
            }};
  models.emplace_back(Material::name);
  if constexpr (sizeof...(Others) > 0)
    return with_material<Others...>(fem, material, std::move(models));
  else
    throw cases::InputError(fem.where,
                            "this formulation needs material.model = " + cases::alternatives(models));
}

} // namespace

#pragma GCC diagnostic error "-Wswitch" // a formulation without its laws must not compile
Formulation make_formulation(const cases::Fem& fem, const cases::Material& material) {
  switch (fem.formulation) {
  case cases::Formulation::small_strain:
    return with_material<SmallStrain, TransverseSmallStrain>(fem, material);
  case cases::Formulation::saint_venant_kirchhoff:
    return with_material<SaintVenantKirchhoff>(fem, material);
  case cases::Formulation::log_strain:
    return with_material<LogStrain, TransverseLogStrain>(fem, material);
  case cases::Formulation::hyperelastic:
    break;
  }
  return with_material<Ogden, Yeoh>(fem, material);
}

std::vector<Formulation> formulations_of(const cases::Scene& scene) {
  std::vector<Formulation> formulations;
  for (const cases::Material& material : cases::materials_of(scene.definition))
    formulations.push_back(make_formulation(scene.definition.fem, material));
  return formulations;
}

std::vector<std::unique_ptr<CellKernel>> kernels_of(const std::vector<Formulation>& formulations,
                                                    const ElementType& element) {
  std::vector<std::unique_ptr<CellKernel>> kernels;
  for (const Formulation& formulation : formulations) kernels.push_back(formulation.make_kernel(element));
  return kernels;
}

} // namespace springproof::fem_reference
