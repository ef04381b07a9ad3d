#include "compare/solve/estimate.hpp"

#include "cases/case/elements.hpp"
#include "cases/case/error.hpp"
#include "cases/mesh/fill_surface.hpp"
#include "cases/mesh/labels.hpp"
#include "cases/mesh/voxels.hpp"
#include "compare/solve/progress.hpp"
#include "compare/solve/solvers.hpp"
#include "compare/solve/springs.hpp"
#include "fem_reference/backend.hpp"
#include "msm/model.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numeric>

namespace springproof::compare {

namespace {

/// Measured on two cores of an Intel Xeon with AVX-512, one thread: seconds (of user time, at commits 874c2b4
/// and 6eb550a) with cases/sweep/cube_shear.toml, 20^3 to 80^3 cells, and with the same block with one edge
/// moved, which is no grid, 6^3 to 46^3; megabytes with all of cases/sweep, 10^3 to 4x10^5 unknowns, and
/// 100^3 cells. Iterations of an easy load are in them; hard loads and nearly incompressible bodies take up
/// to ten times as long.
struct Linear {                     ///< iterative solvers
  double megabytes, bytes, seconds; ///< at least; per entry of a field; per unknown
};
struct Factorised { ///< factorised at every iteration: what 26,460 unknowns take
  double least_megabytes, megabytes, seconds;
};
constexpr Linear grid_linear_element{5, 750, 10e-6};
constexpr Linear grid_bubble_element{5, 950, 20e-6};
constexpr Linear grid_quadratic_element{5, 1250, 25e-6};
constexpr Linear grid_springs{5, 320, 5.5e-6};
constexpr Linear algebraic_multigrid{25, 4000, 115e-6};
/// A beam of 52,653 p2 cells, 230,121 unknowns, and 20^3 q2 cells with a fibre, 201,720.
constexpr Linear multigrid_of_quadratic_tetrahedra{25, 5400, 165e-6};
constexpr Linear multigrid_of_quadratic_hexahedra{25, 8200, 215e-6};
constexpr Factorised finite_elements{25, 650, 6.5};
constexpr Factorised springs_lattice{5, 245, 3};
constexpr double factorised_unknowns = 26460;

/// Steps of methods, of the cube of 20^3 and 30^3 cells: seconds are of an iteration. Vertex block descent
/// takes six times as long, conjugate gradients a fifth.
constexpr Linear stepped{40, 7000, 1e-6};

/// Exponents seen from 10,000 to 60,000 unknowns. A nested dissection of a body takes n^(4/3) and n^2.
constexpr double memory_power = 1.25, time_power = 1.7;

/// Bytes of finite elements in motion beside those of statics, by their types, per entry of a field and per
/// unknown: 14 vectors of the integrator, masses and dampers, which are matrices where tangents are
/// assembled. Bubbles are three times as many numbers as displacements.
constexpr double grid_in_motion = 150, grid_bubbles_in_motion = 490, assembled_in_motion = 2400;

/// Parts of the time of finite strain: one factorisation for four or five, three inexact solves for five.
constexpr double small_strain_factorised = 0.2, small_strain_iterated = 0.6;

const Linear& on_grid(cases::Element element) {
  if (element == cases::Element::q1_wilson) return grid_bubble_element;
  return element == cases::Element::q2 ? grid_quadratic_element : grid_linear_element;
}

const Linear& assembled(cases::Element element) {
  const cases::ElementFacts& facts = cases::facts_of(element);
  if (facts.degree == 1) return algebraic_multigrid;
  return facts.is_tetrahedron ? multigrid_of_quadratic_tetrahedra : multigrid_of_quadratic_hexahedra;
}

Estimate linear(const std::string& model, double unknowns, double n_entries, const Linear& per) {
  return {model, unknowns, per.megabytes + 1e-6 * per.bytes * n_entries, per.seconds * unknowns};
}

Estimate factorised(const std::string& model, double unknowns, const Factorised& at) {
  const double ratio = unknowns / factorised_unknowns;
  return {model, unknowns, at.least_megabytes + at.megabytes * std::pow(ratio, memory_power),
          at.seconds * std::pow(ratio, time_power)};
}

/// Nodes after n uniform refinements: about as many inner nodes as hexahedra, or a sixth as many as
/// tetrahedra, and the others on the surface.
double refined_nodes(const BodySize& body, int n) {
  const bool is_tetrahedron = cases::facts_of(body.outline.definition.fem.element).is_tetrahedron;
  const double inner = is_tetrahedron ? body.n_cells / 6 : body.n_cells;
  return inner * std::pow(8, n) + (body.n_nodes - inner) * std::pow(4, n);
}

/// Displacements of an element's nodes, and the pressures of its vertices if it has such.
double element_unknowns(const BodySize& body) {
  const cases::Fem& fem = body.outline.definition.fem;
  const double pressures = cases::facts_of(fem.element).is_mixed ? refined_nodes(body, fem.refine) : 0;
  return 3 * refined_nodes(body, fem_reference::n_halvings(fem)) + pressures;
}

/// Nodes along the axes of a body's grid after n halvings.
Eigen::Array3d nodes_along(const BodySize& body, int n) {
  const std::array<int, 3>& cells = body.outline.mesh.grid->cells;
  return std::pow(2, n) * Eigen::Array3d(cells[0], cells[1], cells[2]) + 1;
}

/// Entries of a finite elements' field: rows are filled up to packs of 16, planes have neighbours.
double element_entries(const Eigen::Array3d& nodes) {
  return 3 * (16 * std::ceil(nodes.x() / 16) * nodes.y() + 16) * (nodes.z() + 2);
}

/// Entries of a springs' field.
double spring_entries(const Eigen::Array3d& nodes) {
  return 3 * ((nodes.x() + 1) * (nodes.y() + 1) + 56) * (nodes.z() + 2);
}

std::string memory_text(double megabytes) {
  return megabytes < 1e4 ? fmt::format("{:.2g} GB", megabytes / 1e3)
                         : fmt::format("{:.0f} GB", megabytes / 1e3);
}

/// Estimate of a dynamic case. A step takes about as many iterations of Newton's method as half an
/// equilibrium, and a linear body's are not factorised again: an upper bound for these.
Estimate in_time(Estimate equilibrium, const cases::Case& definition) {
  if (!definition.dynamics) return equilibrium;
  equilibrium.seconds *= 0.5 * definition.dynamics->n_steps();
  return equilibrium;
}

/// A model that a method steps: a lattice or elements assembled, and in a motion the factor of its slowest
/// vibration. A body without [dynamics] is estimated to rest in the last of its steps.
template<class Method>
Estimate in_steps(const std::string& model, double unknowns, const cases::StepsBy<Method>& real_time,
                  const cases::Case& definition, const Factorised& at) {
  const auto& dynamics = definition.dynamics;
  const double n_steps = dynamics ? dynamics->n_steps() : real_time.end / real_time.step;
  Estimate estimate = linear(model, unknowns, unknowns, stepped);
  estimate.seconds *= n_steps * real_time.substeps.value_or(1) *
                      (cases::is_explicit(real_time.method) ? 1 : real_time.iterations);
  if (dynamics) estimate.megabytes += factorised(model, unknowns, at).megabytes;
  estimate.is_on_first_rank = true;
  return estimate;
}

/// What is kept of a motion: some bodies, and what measures watch; twice while it goes to the answer.
double bytes_of_motion(const BodySize& body) {
  const auto& dynamics = body.outline.definition.dynamics;
  if (!dynamics) return 0;
  const double n_bodies = std::ceil(double(dynamics->n_steps()) / dynamics->write_every) + 1;
  const double n_watched =
      8. * double(body.outline.definition.measures.size()); // nodes of a measure, at most
  return 2 * 24 * (n_bodies * body.n_nodes + dynamics->n_steps() * n_watched);
}

constexpr double cells_a_node = 5; ///< tetrahedra, in a body of many

} // namespace

BodySize size_of(const cases::Scene& scene) {
  BodySize body{double(scene.mesh.nodes.size()), double(scene.mesh.cells.size()), {}};
  body.outline.definition = scene.definition;
  body.outline.mesh.shape = scene.mesh.shape;
  body.outline.mesh.grid = scene.mesh.grid;
  return body;
}

std::optional<BodySize> size_of(const cases::Case& definition) try {
  BodySize body{1, 1, {}};
  body.outline.definition = definition;
  cases::Grid& grid = body.outline.mesh.grid.emplace();
  if (const auto* box = std::get_if<cases::Box>(&definition.body)) {
    grid.cells = box->cells;
    grid.spacing = box->size.cwiseQuotient(Eigen::Vector3d(grid.cells[0], grid.cells[1], grid.cells[2]));
    for (const int n : box->cells) {
      body.n_cells *= n;
      body.n_nodes *= n + 1.;
    }
    return body;
  }
  const auto* surface = std::get_if<cases::FilledSurface>(&definition.body);
  const std::optional<cases::Voxels> cubes = surface ? cases::as_voxels(*surface) : std::nullopt;
  if (surface && !cubes) {
    body.outline.mesh.grid.reset();
    body.outline.mesh.shape = cases::CellShape::tetrahedron;
    cases::settle_element(body.outline.definition, true);
    body.n_cells = std::max(1., cases::count_tetrahedra(*surface));
    body.n_nodes = body.n_cells / cells_a_node + 10;
    return body;
  }
  if (const auto* voxels = cubes ? &*cubes : std::get_if<cases::Voxels>(&definition.body)) {
    const auto [in_body, of_grid] = cases::count_voxels(*voxels);
    body.n_cells = std::max(1., in_body);
    grid.cells = of_grid;
  } else if (const auto* labels = std::get_if<cases::Labels>(&definition.body)) {
    const cases::LabelGrid labelled = cases::read_label_grid(
        cases::is_in_world(definition.body) ? cases::on_grid(*labels, cases::placement_of(*labels))
                                            : *labels);
    const auto& classes = labelled.class_of_cell;
    body.n_cells =
        static_cast<double>(classes.size() - cases::index(std::count(classes.begin(), classes.end(), 0)));
    grid.cells = labelled.cells;
  } else {
    return std::nullopt;
  }
  body.n_nodes = std::pow(std::cbrt(body.n_cells) + 1, 3); // the count of a cube
  return body;
} catch (const cases::InputError&) { // make_scene() refuses it in its turn
  return std::nullopt;
}

Estimate estimate_fem(const BodySize& body) {
  const cases::Fem& fem = body.outline.definition.fem;
  if (fem.real_time)
    return in_steps("finite elements (in steps)", 3 * refined_nodes(body, fem.refine), *fem.real_time,
                    body.outline.definition, finite_elements);
  const int halvings = fem_reference::n_halvings(fem);
  const double unknowns = element_unknowns(body);
  const auto backend =
      fem_reference::choose_backend(body.outline, fem_reference::n_element_nodes(fem, body.n_nodes));
  const bool is_on_grid = backend == fem_reference::Backend::grid;
  const bool is_factorised = !is_on_grid && fem_reference::takes_factorisation(unknowns / 3, fem);
  const double n_entries = is_on_grid ? element_entries(nodes_along(body, halvings)) : unknowns;
  Estimate estimate;
  if (is_on_grid)
    estimate = linear("finite elements (matrix-free)", unknowns, n_entries, on_grid(fem.element));
  else if (is_factorised)
    estimate = factorised("finite elements (factorised)", unknowns, finite_elements);
  else
    estimate = linear("finite elements (assembled)", unknowns, n_entries, assembled(fem.element));
  if (cases::facts_of(fem.element).is_mixed)
    estimate.remedy = "take p2_p0, which large bodies do not factorise, or " + estimate.remedy;
  if (body.outline.definition.dynamics)
    estimate.megabytes += 1e-6 * n_entries *
                          (!is_on_grid                                ? assembled_in_motion
                           : fem.element == cases::Element::q1_wilson ? grid_bubbles_in_motion
                                                                      : grid_in_motion);
  if (fem.formulation == cases::Formulation::small_strain)
    estimate.seconds *= is_factorised ? small_strain_factorised : small_strain_iterated;
  return in_time(estimate, body.outline.definition);
}

Estimate estimate_springs(const BodySize& body) {
  const double unknowns = 3 * body.n_nodes;
  const cases::Case& definition = body.outline.definition;
  if (definition.msm.real_time)
    return in_steps("springs (in steps)", unknowns, *definition.msm.real_time, definition, springs_lattice);
  const bool is_on_grid = body.outline.mesh.grid && !is_assembled(body.outline);
  Estimate estimate;
  if (is_on_grid && msm::prefers_multigrid(definition, *body.outline.mesh.grid, body.n_nodes))
    estimate = linear("springs (matrix-free)", unknowns, spring_entries(nodes_along(body, 0)), grid_springs);
  else
    estimate = factorised("springs (factorised)", unknowns, springs_lattice);
  estimate.is_on_first_rank = definition.msm.solver != cases::Solver::snes;
  return in_time(estimate, definition);
}

Estimate estimate_free_springs(const BodySize& body) {
  Estimate springs = factorised("springs (factorised)", 3 * body.n_nodes, springs_lattice);
  springs.is_on_first_rank = true;
  return springs;
}

std::vector<Estimate> estimate_vibrations(const BodySize& body) {
  std::vector<Estimate> models{
      factorised("finite elements (factorised)", element_unknowns(body), finite_elements),
      estimate_free_springs(body)};
  for (Estimate& model : models) model.is_on_first_rank = true;
  return models;
}

std::vector<Estimate> estimate(const BodySize& body, const Request& request) {
  std::vector<Estimate> models;
  if (request.asks(cases::Side::fem)) {
    models.push_back(estimate_fem(body));
    BodySize refined = body;
    refined.outline.definition.fem.real_time.reset();
    int& refine = refined.outline.definition.fem.refine;
    const int own = refine, finest = std::max(request.meshes - 1, own);
    for (refine = finest - request.meshes + 1; refine <= finest; ++refine)
      if (refine != own || body.outline.definition.fem.real_time) models.push_back(estimate_fem(refined));
  }
  if (request.asks(cases::Side::msm)) models.push_back(estimate_springs(body));
  // Fields are made while the model is there still. By their types: FieldSums and Fields of a cell and a
  // node, and what ranks send each other of them. A static solve makes them to check its reactions.
  constexpr double bytes_of_fields = 400;
  if (body.outline.definition.has_fields || !body.outline.definition.dynamics)
    for (Estimate& model : models) model.megabytes += 1e-6 * bytes_of_fields * body.n_cells;
  const double motion = 1e-6 * bytes_of_motion(body);
  for (Estimate& model : models) {
    if (motion > model.megabytes)
      model.remedy = "take fewer or longer steps in [dynamics], or a larger write_every";
    model.megabytes += motion;
    model.megabytes_of_each += motion;
  }
  return models;
}

std::vector<Estimate> estimate(const Question& question) {
  const auto& [scene, request] = question;
  if (cases::has_cells(scene.definition.body)) return estimate(size_of(scene), request);
  std::vector<Estimate> models;
  for (const auto& [side, body] :
       {std::pair{cases::Side::fem, scene.of_fem.empty() ? nullptr : &scene.of_fem.front()},
        std::pair{cases::Side::msm, &scene}}) {
    Request of_side = request;
    of_side.only = side;
    if (!body || !request.asks(side)) continue;
    const std::vector<Estimate> more = estimate(size_of(*body), of_side);
    models.insert(models.end(), more.begin(), more.end());
  }
  return models;
}

double total_seconds(const std::vector<Estimate>& models) {
  return std::accumulate(models.begin(), models.end(), 0.,
                         [](double sum, const Estimate& model) { return sum + model.seconds; });
}

double most_megabytes(const std::vector<Estimate>& models) {
  return std::accumulate(models.begin(), models.end(), 0.,
                         [](double most, const Estimate& model) { return std::max(most, model.megabytes); });
}

std::string long_solve_text(const std::string& name, const std::vector<Estimate>& models) {
  constexpr double long_seconds = 10;
  if (total_seconds(models) < long_seconds) return "";
  std::string text = name;
  for (const Estimate& model : models)
    text += fmt::format("{} {}: {:.3g} unknowns, about {} and {}", &model == &models.front() ? ":" : ";",
                        model.model, model.unknowns, memory_text(model.megabytes), clock_text(model.seconds));
  return text;
}

RanksOfMachine ranks_of_machine() {
  return {n_mpi_ranks(), n_mpi_ranks_here()};
}

double megabytes_within(const MemoryLimit& limit, const Estimate& model, const RanksOfMachine& ranks) {
  const int n_within = limit.is_of_a_process ? 1 : ranks.here;
  const double rest = model.megabytes - model.megabytes_of_each, of_each = model.megabytes_of_each * n_within;
  return (model.is_on_first_rank ? rest : rest * n_within / ranks.all) + of_each;
}

void check_memory(const std::string& file, const std::vector<Estimate>& models, const MemoryLimit& limit) {
  for (const Estimate& model : models) {
    const double megabytes = megabytes_within(limit, model);
    if (!(megabytes <= limit.megabytes))
      throw cases::InputError(
          fmt::format("{}: {} with about {:.3g} unknowns need about {} of memory, and {} leaves {}: {}", file,
                      model.model, model.unknowns, memory_text(megabytes), limit.of,
                      memory_text(std::max(0., limit.megabytes)), model.remedy));
  }
}

cases::Scene make_scene_within_memory(const cases::Case& definition) {
  // Nodes, cells, and what selecting regions takes for a while, which is all that a box takes.
  const double bytes_a_node = std::holds_alternative<cases::Box>(definition.body) ? 10 : 150;
  if (const auto body = size_of(definition)) {
    const double megabytes = 1e-6 * bytes_a_node * body->n_nodes;
    check_memory(definition.file, {{"the mesh's nodes", 3 * body->n_nodes, megabytes, 0, megabytes}},
                 memory_limit());
  }
  return cases::make_scene(definition);
}

void check_memory(const std::vector<Question>& questions) {
  // What the solvers' libraries take is no longer left.
  if (memory_limit().is_of_a_process &&
      std::any_of(questions.begin(), questions.end(),
                  [](const Question& question) { return question.request.asks(cases::Side::fem); }))
    solvers();
  const MemoryLimit limit = memory_limit();
  for (const Question& question : questions)
    check_memory(question.scene.definition.file, estimate(question), limit);
}

int workers_within(const MemoryLimit& limit, std::vector<double> megabytes, int n_workers) {
  if (limit.is_of_a_process) return n_workers;
  std::sort(megabytes.begin(), megabytes.end(), std::greater<>());
  double sum = 0;
  for (int n = 0; n < n_workers && cases::index(n) < megabytes.size(); ++n) {
    sum += megabytes[cases::index(n)];
    if (!(sum <= limit.megabytes)) return std::max(1, n);
  }
  return n_workers;
}

} // namespace springproof::compare
