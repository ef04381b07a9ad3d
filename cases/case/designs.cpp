#include "cases/case/designs.hpp"

#include "cases/case/models.hpp"

#include <array>

namespace springproof::cases {

namespace {

template<class Condition>
std::string designs_that(const Condition& fulfil) {
  std::vector<Design> found;
  for (const DesignFacts& facts : all_designs())
    if (fulfil(facts.design)) found.push_back(facts.design);
  return alternatives(found);
}

} // namespace

const std::vector<DesignFacts>& all_designs() {
  using D = Design;
  static const std::vector<DesignFacts> all{
      {D::linear_method,
       "the springs whose linearised stiffness matrix is closest to the finite element's",
       "San-Vicente, thesis, eq. 4.15",
       {"poissons_ratio"},
       DesignRatio{{}, true}},
      {D::nonlinear_method,
       "the springs that fit a uniaxial curve and its lateral strain",
       "San-Vicente, thesis, eq. 5.9",
       {"poissons_ratio", "strain_range"},
       DesignLaw::hooke},
      {D::moduli,
       "springs whose lattice has E along its axes and G between them",
       "docs/using/designs.md",
       {"poissons_ratio", "split"}},
      {D::hybrid,
       "springs and a volume term whose lattice is isotropic with E and nu",
       "the family of Golec et al. 2020, doi 10.1007/s00371-019-01663-0",
       {"poissons_ratio", "split"},
       DesignRatio{0}},
      {D::matched,
       "the hybrid's stiffnesses with power-log springs that follow the material's law",
       "docs/using/designs.md",
       {"poissons_ratio", "split", "strain_range"},
       DesignLaw::power_log,
       DesignRatio{0}},
      {D::midline,
       "the matched's moduli and curves, and bending as a bar's, by springs between the centres of faces",
       "docs/developing/midlines.md",
       {"poissons_ratio", "split", "strain_range", "beta"},
       DesignLaw::fitted_or_hooke,
       DesignMaterial::any,
       DesignRatio{0}},
      {D::multi_load,
       "springs and a volume term that fit stresses along several homogeneous paths",
       "docs/using/designs.md",
       {"poissons_ratio", "split", "paths", "weights", "volume_term", "strain_range"},
       DesignLaw::fitted},
      {D::ladd_kinney,
       "edges and face diagonals of one stiffness inside: isotropic with E and nu = 1/4, whatever the "
       "material's",
       "Ladd & Kinney 1997; Kot, Nagahashi & Szymczak 2015, Vis Comput 31:1339",
       {}},
      {D::baudet,
       "edges and internal diagonals; the published lateral correction force, which has no energy, is left "
       "out",
       "Baudet et al. 2009, hal-00994456",
       {"poissons_ratio"},
       DesignRatio{-0.25}},
      {D::uniform,
       "one stiffness for every spring, those at the boundary not halved",
       "what simulators ship: SOFA's RegularGridSpringForceField, Vega's MassSpringSystem from cubes",
       {"stiffness"},
       DesignCells::terms},
      {D::van_gelder,
       "cells cut into five tetrahedra, every edge of which adds E V/l^2",
       "Van Gelder 1998",
       {},
       DesignCells::cut},
      {D::lloyd,
       "the same cut, every edge of a tetrahedron adds a share of E by its volume",
       "Lloyd, Szekely & Harders 2007",
       {},
       DesignCells::cut},
      {D::biquadratic,
       "the same cut with biquadratic springs: linear tetrahedra of St. Venant-Kirchhoff",
       "Delingette 2008, in three dimensions",
       {"poissons_ratio"},
       DesignLaw::biquadratic,
       DesignCells::cut},
      {D::transverse,
       "springs by axis and a volume term with the moduli nearest to a transversely isotropic material's",
       "docs/using/designs.md",
       {"split"},
       DesignCells::terms,
       DesignMaterial::transversely_isotropic},
      {D::given,
       "the stiffnesses of the case file",
       "the case file",
       {"stiffness", "axis_stiffness", "volume_stiffness"},
       DesignSource::file,
       DesignMaterial::any},
      {D::network,
       "springs between any nodes of the mesh, one by one",
       "a CSV file",
       {"file"},
       DesignLaw::by_spring,
       DesignSource::file,
       DesignCells::terms,
       DesignMaterial::any},
  };
  return all;
}

const DesignFacts& facts_of(Design design) {
  return all_designs().at(static_cast<std::size_t>(design));
}

std::vector<std::string> keys_of_designs() {
  std::vector<std::string> keys;
  for (const DesignFacts& facts : all_designs())
    for (const std::string& key : facts.keys)
      if (!contains(keys, key)) keys.push_back(key);
  return keys;
}

bool takes(Design design, const std::string& key) {
  return contains(facts_of(design).keys, key);
}

bool is_of_others(Design design) {
  using D = Design;
  return contains(std::array{D::ladd_kinney, D::baudet, D::uniform, D::van_gelder, D::lloyd, D::biquadratic},
                  design);
}

std::string designs_with(const std::string& key) {
  return designs_that([&](Design design) { return takes(design, key); });
}

namespace {

/// Whether materials have exponents of their own.
bool have_other_exponents(const std::vector<Material>& materials) {
  if (materials.size() == 1) return false;
  return std::any_of(materials.begin(), materials.end(), [&](const Material& material) {
    const auto ratio_of = [](const Material& m) { return std::get<LinearElastic>(m).poissons_ratio; };
    return !std::holds_alternative<LinearElastic>(material) ||
           ratio_of(material) != ratio_of(materials.front());
  });
}

} // namespace

void settle_design(Msm& msm, bool is_tetrahedron) {
  if (!is_tetrahedron || !msm.has_auto_design) return;
  msm.design = Design::hybrid;
  msm.law.reset();
}

SpringLaw law_of(const Msm& msm, const Material& material) {
  const DesignLaw law = facts_of(msm.design).law;
  const bool finds_exponents =
      law == DesignLaw::power_log || (law == DesignLaw::fitted_or_hooke && is_isotropic(material) &&
                                      !(msm.poissons_ratio.value_or(poissons_ratio_of(material)) < 0.25));
  return msm.law.value_or(finds_exponents ? SpringLaw::power_log : SpringLaw::hooke);
}

void settle_law(Msm& msm, const std::vector<Material>& materials, bool has_nodal_forces) {
  if (msm.law || facts_of(msm.design).law != DesignLaw::fitted_or_hooke) return;
  const bool gives_way =
      has_nodal_forces && std::any_of(materials.begin(), materials.end(), [&](const Material& material) {
        return std::holds_alternative<LinearElastic>(material) &&
               msm.poissons_ratio.value_or(poissons_ratio_of(material)) > 0.35;
      });
  if (gives_way || have_other_exponents(materials)) msm.law = SpringLaw::hooke;
}

bool is_for(Design design, bool is_isotropic) {
  const DesignMaterial wanted = facts_of(design).material;
  return wanted == DesignMaterial::any || (wanted == DesignMaterial::isotropic) == is_isotropic;
}

std::string designs_for(bool is_isotropic) {
  return designs_that([&](Design design) { return is_for(design, is_isotropic); });
}

} // namespace springproof::cases
