#include "fem_reference/assembled_body.hpp"

#include "cases/case/elements.hpp"
#include "cases/scene/loads.hpp"
#include "fem_reference/model.hpp"
#include "scenes.hpp"
#include "solved.hpp"
#include "tests/fem_reference/laws/point_law.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numeric>

using namespace springproof;

using namespace fem_reference;
using namespace point_laws;
using cases::Element;
using Eigen::Vector3d;

namespace fields_of_elements {

namespace {

Matrix3 matrix_of(const cases::SymmetricTensor& t) {
  Matrix3 m;
  m << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
  return m;
}

Matrix3 unflattened(const Vector9& v) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(v.data());
}

struct LawOfFormulation {
  cases::Formulation formulation;
  cases::Material material;
  PointLaw law;
};

std::vector<LawOfFormulation> laws() {
  const cases::LinearElastic elastic = scenes::thesis_elastic();
  const cases::Ogden ogden{{0.1, 0.2, -0.05}, {5.7255, 0.5, -3.}, 2.};
  const cases::TransverselyIsotropic fibrous = scenes::fibrous({1, 2, -0.5});
  return {{cases::Formulation::small_strain, elastic, point_law<SmallStrain>(elastic)},
          {cases::Formulation::saint_venant_kirchhoff, elastic, point_law<SaintVenantKirchhoff>(elastic)},
          {cases::Formulation::log_strain, elastic, point_law<LogStrain>(elastic)},
          {cases::Formulation::small_strain, fibrous, point_law<TransverseSmallStrain>(fibrous)},
          {cases::Formulation::log_strain, fibrous, point_law<TransverseLogStrain>(fibrous)},
          {cases::Formulation::hyperelastic, ogden, point_law<Ogden>(ogden)}};
}

cases::Fields fields_of(Solved& solved, const cases::Scene& scene) {
  return fem_reference::fields_of(
      elements_of(scene, {solved.formulation}, solved.discretisation, solved.equations, solved.state),
      nullptr, 0);
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.);
}

Vector3d sum(const std::vector<Vector3d>& vectors) {
  return std::accumulate(vectors.begin(), vectors.end(), Vector3d(0, 0, 0));
}

cases::Case block(cases::Formulation formulation, Element element, const Vector3d& value) {
  cases::Case definition = scenes::cube(scenes::Test::shear, scenes::LoadSet::small, scenes::thesis_elastic(),
                                        formulation, element, 4);
  definition.loads = {scenes::traction("z+", value)};
  return definition;
}

} // namespace

TEST_CASE("distorted cells under a uniform strain have the law's stress, its energy and that strain",
          "[verification]") {
  Matrix3 stretched;
  stretched << 1.10, 0.03, -0.02, 0.04, 0.94, 0.01, 0.02, -0.05, 1.08;
  const Matrix3 turned =
      Eigen::AngleAxisd(0.3, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix() * stretched;
  for (const auto& [formulation, material, law] : laws())
    for (const Element element : scenes::all_elements) {
      if (law.split == Split::none && cases::facts_of(element).has_pressure) continue;
      const bool is_linear = law.kinematics == Kinematics::linear;
      const Matrix3 f = is_linear ? stretched : turned;
      const auto scene = scenes::distorted_box(3, scenes::Surface::fixed, material, formulation, element);
      Solved solved(scene, {nullptr, [&](const Vector3d& x) { return Vector3d(f * x - x); }});
      const cases::Fields fields = fields_of(solved, scene);
      const Matrix3 first = unflattened(whole_stress(law, f));
      const Matrix3 stress = is_linear ? first : Matrix3(first * f.transpose() / f.determinant());
      const Matrix3 gradient = f - Matrix3::Identity();
      const Matrix3 strain = is_linear ? Matrix3((gradient + gradient.transpose()) / 2)
                                       : mechanics::logarithmic_strain(gradient);
      CAPTURE(cases::name_of(formulation), cases::name_of(element));
      // a solve to 1e-10 of its forces; the pressure modes hold volumes to 1e-12, times bulk over shear
      constexpr double solved_to = 1e-8;
      for (const auto& cell : fields.stress)
        CHECK((matrix_of(cell) - stress).norm() <= solved_to * stress.norm());
      for (const auto& cell : fields.strain)
        CHECK((matrix_of(cell) - strain).norm() <= solved_to * strain.norm());
      CHECK(sum(fields.strain_energy) == Approx(law.energy(f)).epsilon(solved_to)); // 1 mm³
      CHECK(sum(fields.reaction).norm() <= 1e-9 * stress.norm());                   // all around: 1 mm²
    }
}

TEST_CASE("the logarithmic strain keeps the digits of small strains and turns with the body") {
  Matrix3 small;
  small << 1, 2, 3, 2, -4, 5, 3, 5, 6;
  small *= 1e-9;
  CHECK((mechanics::logarithmic_strain(small) - small).norm() <= 1e-7 * small.norm()); // strain²
  const Matrix3 q = Eigen::AngleAxisd(2.1, Vector3d(3, 1, 2).normalized()).toRotationMatrix();
  const Matrix3 stretch = Vector3d(1.5, 0.7, 1.1).asDiagonal();
  const Matrix3 log = Vector3d(std::log(1.5), std::log(0.7), std::log(1.1)).asDiagonal();
  CHECK((mechanics::logarithmic_strain(stretch - Matrix3::Identity()) - log).norm() <= 1e-14);
  CHECK((mechanics::logarithmic_strain(q * stretch - Matrix3::Identity()) - q * log * q.transpose()).norm() <=
        1e-13);
  CHECK(mechanics::logarithmic_strain(-Matrix3::Identity()).allFinite()); // pressed to nothing
}

TEST_CASE("the reaction of a clamped face is the applied load, on every backend, element and refined mesh",
          "[verification]") {
  const Vector3d value(0.004, -0.001, 0.003);
  for (const auto backend : {Backend::assembled, Backend::grid})
    for (const auto element : {Element::q1, Element::q1_bbar, Element::q1_wilson, Element::q2, Element::q2_p1,
                               Element::p1, Element::p2_p0, Element::p2_p1})
      for (const int refine : {0, 1}) {
        const cases::ElementFacts& facts = cases::facts_of(element);
        if (backend == Backend::grid && (element == Element::q2_p1 || facts.is_tetrahedron)) continue;
        if (refine == 1 && facts.degree == 2 && element != Element::p2_p0) continue; // seconds
        cases::Case definition = block(cases::Formulation::log_strain, element, value);
        definition.fem.refine = refine;
        const cases::Scene scene = tetrahedra::make_scene(definition);
        Model model(scene, MPI_COMM_SELF, backend);
        const cases::Solution solution = model.solve();
        const cases::Fields fields = model.fields(nullptr);
        CAPTURE(int(backend), cases::name_of(element), refine);
        const Vector3d load = 100 * value;
        CHECK((sum(fields.reaction) + load).norm() <= 1e-8 * load.norm()); // the solver's 1e-10
        Vector3d moment = Vector3d::Zero();
        const auto forces = cases::nodal_forces(scene);
        for (std::size_t n = 0; n < forces.size(); ++n)
          if (scene.mesh.nodes[n].z() > 1e-9)
            CHECK(fields.reaction[n].isZero(0)); // nothing is held there
          else
            moment += scene.mesh.nodes[n].cross(fields.reaction[n]);
        if (refine == 0 && element == Element::q1) { // whose nodes all are the body's
          for (std::size_t n = 0; n < forces.size(); ++n)
            moment += (scene.mesh.nodes[n] + solution.displacement[n]).cross(forces[n]);
          CHECK(moment.norm() <= 1e-7 * load.norm() * 10);
        }
      }
}

TEST_CASE("at half the load of a model solved again the reaction is half of the load", "[verification]") {
  const auto backend = GENERATE(Backend::assembled, Backend::grid);
  const Vector3d value(0.004, 0, 0);
  Model model(cases::make_scene(block(cases::Formulation::small_strain, Element::q1_bbar, value)),
              MPI_COMM_SELF, backend);
  model.solve();
  model.solve_again(0.5);
  CHECK((sum(model.fields(nullptr).reaction) + 50 * value).norm() <= 1e-8 * 50 * value.norm());
}

TEST_CASE("the strain energy of small strains is half the work of the load", "[verification]") {
  for (const auto element : {Element::q1, Element::q1_bbar, Element::q1_wilson}) {
    const cases::Scene scene =
        cases::make_scene(block(cases::Formulation::small_strain, element, {0.004, -0.001, 0.003}));
    Model model(scene, MPI_COMM_SELF);
    const cases::Solution solution = model.solve();
    const auto forces = cases::nodal_forces(scene);
    double work = 0;
    for (std::size_t n = 0; n < forces.size(); ++n) work += forces[n].dot(solution.displacement[n]);
    CAPTURE(cases::name_of(element));
    CHECK(sum(model.fields(nullptr).strain_energy) == Approx(work / 2).epsilon(1e-8));
  }
}

TEST_CASE("the strain energy of a finite strain is the work of the load on its way", "[verification]") {
  cases::Case definition =
      block(cases::Formulation::hyperelastic, Element::q1_p0, {0.02, 0, 0.01}); // strains of 0.3
  definition.material = cases::Ogden{{0.1}, {2}, 0.5};
  const cases::Scene scene = cases::make_scene(definition);
  const auto forces = cases::nodal_forces(scene);
  Model model(scene, MPI_COMM_SELF);
  const std::size_t n = 8; // Simpson's rule on a smooth path: (1/n)⁴
  std::vector<double> way{0};
  for (std::size_t i = 1; i <= n; ++i) {
    const cases::Solution solution = model.solve_again(double(i) / double(n));
    double against = 0;
    for (std::size_t node = 0; node < forces.size(); ++node)
      against += forces[node].dot(solution.displacement[node]);
    way.push_back(against);
  }
  double complementary = 0; // integral of u over the load; work is load times way less that
  for (std::size_t i = 0; i < n; i += 2)
    complementary += (way[i] + 4 * way[i + 1] + way[i + 2]) / (3 * double(n));
  CHECK(sum(model.fields(nullptr).strain_energy) == Approx(way.back() - complementary).epsilon(1e-4));
}

TEST_CASE("a cell's stress, strain and energy approach their limits with the square of the mesh width",
          "[verification][long]") {
  const auto field = [](const Vector3d& x) -> Vector3d {
    return 0.06 * Vector3d(std::sin(2 * x.y() + x.z()), std::cos(2 * x.x() - x.z()),
                           std::sin(1.5 * x.x() + 1.5 * x.y() - x.z()));
  };
  auto body = scenes::distorted_box(2, scenes::Surface::fixed, scenes::thesis_elastic(),
                                    cases::Formulation::log_strain, Element::q1);
  std::vector<std::array<double, 3>> values;
  for (const int refine : {2, 3, 4}) {
    cases::Scene fine = body;
    fine.constrained.clear();
    for (int i = 0; i < refine; ++i) fine.mesh = cases::refine(fine.mesh);
    const Formulation formulation = make_formulation(fine.definition.fem, fine.definition.material);
    const Discretisation discretisation(fine, element_type(fine.definition.fem, formulation), MPI_COMM_SELF);
    EquilibriumEquations equations(discretisation, {formulation});
    State state = equations.rest();
    for (std::size_t n = 0; n < discretisation.nodes.point.size(); ++n)
      state.segment<3>(Eigen::Index(3 * n)) = field(discretisation.nodes.point[n]);
    body.definition.fem.refine = refine;
    const cases::Fields fields = fem_reference::fields_of(
        elements_of(body, {formulation}, discretisation, equations, state), nullptr, 0);
    values.push_back({fields.stress[3][0], fields.strain[3][3], fields.strain_energy[3]});
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double ratio = (values[0][i] - values[1][i]) / (values[1][i] - values[2][i]);
    CAPTURE(i, values[0][i], values[1][i], values[2][i]);
    CHECK(ratio == Approx(4).epsilon(0.1)); // width²; the next term is width⁴ = 1/16 of it
  }
}

TEST_CASE("a refined tetrahedron knows its place in the body's cell") {
  const cases::Mesh body = bodies::cut_in_tetrahedra(cases::make_box_mesh({2, 1, 1}, {2, 1, 1}));
  const cases::Mesh fine = cases::refine(cases::refine(body));
  for (std::size_t c = 0; c < fine.cells.size(); ++c) {
    const ElementPlace place = place_of(body.shape, c, 2);
    const cases::CellCorners corners = cases::cell_corners(fine, c);
    REQUIRE(place.cell < body.cells.size());
    for (std::size_t v = 0; v < 4; ++v) {
      const Vector3d vertex(v == 1, v == 2, v == 3);
      const Vector3d found =
          cases::image(cases::cell_corners(body, place.cell), place.origin + place.axes * vertex);
      CHECK((found - corners[v]).norm() <= 1e-15);
    }
  }
}

TEST_CASE("a refined cell knows its place in the body's cell") {
  const cases::Mesh body = cases::make_box_mesh({2, 1, 1}, {2, 1, 1});
  const cases::Mesh fine = cases::refine(cases::refine(body));
  for (std::size_t c = 0; c < fine.cells.size(); ++c) {
    const ElementPlace place = place_of(body.shape, c, 2);
    const Vector3d corner = fine.nodes[cases::index(fine.cells[c][0])];
    CAPTURE(c);
    REQUIRE(place.cell < 2);
    CHECK(place.axes == Eigen::Matrix3d(0.25 * Eigen::Matrix3d::Identity()));
    CHECK((corner - (place.origin + Vector3d(double(place.cell), 0, 0))).norm() <= 1e-15);
  }
}

} // namespace fields_of_elements
