#pragma once

#include "cases/case/names.hpp"
#include "cases/scene/scene.hpp"

#include <functional>

using namespace springproof;

/// Scenes that the tests of the finite-element side share.
namespace scenes {

constexpr cases::Element all_elements[] = {
    cases::Element::q1,    cases::Element::q1_bbar, cases::Element::q1_p0, cases::Element::q1_wilson,
    cases::Element::q2,    cases::Element::q2_p1,   cases::Element::p1,    cases::Element::p2,
    cases::Element::p2_p0, cases::Element::p2_p1};

inline cases::Load traction(const std::string& where, const Eigen::Vector3d& value) {
  return {{where}, cases::loads::Traction{value}};
}
/// Faces that are held along their normals: "x-", "z+" ...
std::vector<cases::Fixed> on_rollers(const std::vector<std::string>& faces);

enum class Test { tensile, shear, torsion };
enum class LoadSet { small, large };

/// The thesis's cube: 10 x 10 x 10 mm, as many cells unless asked otherwise, z = 0 clamped, one load set on
/// its top.
cases::Case cube(Test test, LoadSet set, const cases::Material& material, cases::Formulation formulation,
                 cases::Element element, int cells = 10);

cases::LinearElastic thesis_elastic(double poissons_ratio = 0.35);
cases::Ogden thesis_ogden();
/// A material three times as stiff along its fibre.  @param fibre  a vector of any length
cases::TransverselyIsotropic fibrous(const Eigen::Vector3d& fibre);

/// The two measures of a test, by their definition in the thesis: heights (mm), tilts or twists (degrees).
std::array<double, 2> cube_measures(Test test, const cases::Mesh& mesh,
                                    const std::vector<Eigen::Vector3d>& displacement);

/// A box whose interior nodes have been moved, so that no two cells are alike, of cells of the element's
/// shape; every node of its surface is fixed unless free_surface says otherwise.
enum class Surface { fixed, free };
cases::Scene distorted_box(int cells, Surface surface, const cases::Material& material,
                           cases::Formulation formulation, cases::Element element);

} // namespace scenes
