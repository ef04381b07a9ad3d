#include "msm/vibrating_lattice.hpp"

#include "cases/scene/masses.hpp"
#include "msm/tangent.hpp"

namespace springproof::msm {

mechanics::VibratingBody vibrating_body(const cases::Scene& scene, const Lattice& lattice) {
  Tangent tangent(lattice, cases::constrained_dofs(scene));
  mechanics::VibratingBody body;
  body.stiffness = tangent.assemble(lattice.rest, TransverseTerm::exact).selfadjointView<Eigen::Lower>();
  const std::vector<double> masses = cases::point_masses(scene);
  const std::vector<int>& number = tangent.free_number();
  body.mesh_dof.resize(cases::index(tangent.n_free()));
  std::vector<Eigen::Triplet<double>> diagonal;
  for (std::size_t dof = 0; dof < number.size(); ++dof) {
    if (number[dof] < 0) continue;
    diagonal.emplace_back(number[dof], number[dof], masses[dof / 3]);
    body.mesh_dof[cases::index(number[dof])] = static_cast<Eigen::Index>(dof);
  }
  body.mass.resize(tangent.n_free(), tangent.n_free());
  body.mass.setFromTriplets(diagonal.begin(), diagonal.end());
  return body;
}

} // namespace springproof::msm
