#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/element.hpp"

#include <functional>
#include <memory>

namespace springproof::fem_reference {

/// A law with its material, as the rest of the model knows it: what it is like, and the kernel it is inlined
/// in.
struct Formulation : LawTraits {
  std::function<std::unique_ptr<CellKernel>(const ElementType& element)> make_kernel;
};

/// The formulation a case asks for, with its material.
/// @throws InputError when the material does not belong to it
Formulation make_formulation(const cases::Fem& fem, const cases::Material& material);

/// The case's formulation with each of the scene's materials.
std::vector<Formulation> formulations_of(const cases::Scene& scene);

/// Their kernels for an element.
std::vector<std::unique_ptr<CellKernel>> kernels_of(const std::vector<Formulation>& formulations,
                                                    const ElementType& element);

} // namespace springproof::fem_reference
