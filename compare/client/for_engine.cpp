#include "compare/client/for_engine.hpp"

#include "cases/case/error.hpp"
#include "cases/case/installation.hpp"
#include "cases/case/read_case.hpp"
#include "compare/client/league.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// What an engine takes of a spring or a volume.
enum class Takes { compliances, stiffnesses, moduli };

struct EngineFacts {
  const char* name; ///< its client's in clients/league.toml, where it has one
  Takes takes;
  bool has_all_terms; ///< a lattice's; otherwise springs of Hooke's law and volumes of tetrahedra
  std::vector<const char*> cannot;
  const char* without_client;   ///< how to find its error where no client comes with this program
  bool has_six_volumes = false; ///< constrains 6 V, not V
};

const char* const tetrahedra_alone =
    "hexahedra: each is cut into six tetrahedra, which are stiffer in bending";
const char* const own_volumes =
    "volume terms of whole cells: that both tetrahedra inscribed in a cell keep their "
    "volumes is one constraint a cell more";
const char* const by_iterations =
    "an equilibrium that does not depend on step and iterations: what they leave unsolved adds to the error";
const char* const as_files =
    "springproof export CASE --to csv --out DIR, and the engine's displacements by springproof run CASE "
    "--msm-displacements FILE; or a client of your own by --client NAME=COMMAND";

EngineFacts facts_of(Engine engine) {
#pragma GCC diagnostic error "-Wswitch" // an engine that is forgotten here must not compile
  switch (engine) {
  case Engine::jolt:
    return {"Jolt",
            Takes::compliances,
            false,
            {by_iterations, own_volumes, "midlines, other laws than Hooke's, stiffnesses of 0 or less",
             "supports of single components, stiffness damping"},
            as_files,
            true};
  case Engine::xpbd:
    return {"XPBD", Takes::compliances, false, {by_iterations, own_volumes}, as_files};
  case Engine::rapier:
    return {"Rapier", Takes::moduli, false, {by_iterations, tetrahedra_alone, "springs"}, as_files};
  case Engine::mujoco:
    return {"MuJoCo",
            Takes::moduli,
            false,
            {tetrahedra_alone, "springs", "large steps: its elastic forces are explicit"},
            as_files};
  case Engine::bullet:
    return {"Bullet",
            Takes::moduli,
            false,
            {tetrahedra_alone, "springs of more than two stiffnesses",
             "large steps: its elastic forces are explicit"},
            as_files};
  case Engine::unity:
    return {"Unity",
            Takes::stiffnesses,
            true,
            {"terms other than springs without Forces.cs, which export --to csv writes"},
            as_files};
  case Engine::sofa:
    return {"SOFA",
            Takes::stiffnesses,
            true,
            {"terms other than springs without the force field in numpy that export --to sofa writes"},
            "springproof export CASE --to sofa --out DIR, runSofa DIR/scene.py, and its displacements by "
            "springproof run CASE --msm-displacements FILE"};
  case Engine::usd:
    break;
  }
  return {"USD", Takes::moduli, false, {tetrahedra_alone, "springs"}, as_files};
}

/// Numbers of springs and volume terms, in SI units.
std::vector<EngineNumber> numbers_of(const EngineFacts& facts, const msm::DesignResult& design, double edge) {
  const msm::CellStiffness& k = design.stiffness;
  std::vector<EngineNumber> numbers;
  const bool inverse = facts.takes == Takes::compliances;
  const auto add = [&](const char* name, double stiffness) { // N/mm
    if (stiffness == 0) return;
    numbers.push_back({fmt::format("{} of {}", inverse ? "compliance" : "stiffness", name),
                       inverse ? 1 / (1e3 * stiffness) : 1e3 * stiffness, inverse ? "m/N" : "N/m"});
  };
  if (design.springs.terms()) { // four stiffnesses: those at the boundary are not halved
    add("every spring", k.internal_diagonal);
    return numbers;
  }
  add("an edge of one cell", k.edge);
  add("an edge of two cells", 2 * k.edge);
  add("an edge of four cells", 4 * k.edge);
  add("a face's diagonal of one cell", k.face_diagonal);
  add("a face's diagonal of two cells", 2 * k.face_diagonal);
  add("an internal diagonal", k.internal_diagonal);
  add("a midline", k.midline);
  if (k.exponents)
    for (const auto& [name, n] : {std::pair{"edges", 0}, {"face diagonals", 1}, {"internal diagonals", 2}})
      numbers.push_back({fmt::format("exponent of {}", name), k.exponents->by_kind[cases::index(n)], "1"});
  if (k.volume == 0) return numbers;
  if (!inverse) {
    numbers.push_back({"k_v of a cell", 1e6 * k.volume, "Pa"});
    return numbers;
  }
  // Energy k_v/2 V0 (V/V0 - 1)², of a constraint of V or, in Jolt, of 6 V.
  // The two tetrahedra inscribed in a cell have a third of its volume each: both together its energy.
  const double compliance = 2. / 9 * std::pow(1e-3 * edge, 3) / (1e6 * k.volume);
  if (facts.has_six_volumes)
    numbers.push_back(
        {"compliance of 6 V of an inscribed tetrahedron, two a cell", 36 * compliance, "m^5/N"});
  else
    numbers.push_back({"compliance of V of an inscribed tetrahedron, two a cell", compliance, "m^5/N"});
  return numbers;
}

std::vector<EngineNumber> moduli_of(Engine engine, const cases::LinearElastic& material) {
  const double young = 1e6 * material.youngs_modulus, nu = material.poissons_ratio;
  const mechanics::ElasticModuli lame = mechanics::elastic_moduli(material);
  if (engine == Engine::bullet) return {{"mu", 1e6 * lame.mu, "Pa"}, {"lambda", 1e6 * lame.lambda, "Pa"}};
  const bool is_usd = engine == Engine::usd;
  return {{engine == Engine::rapier ? "youngModulus"
           : is_usd                 ? "physxDeformableBodyMaterial:youngsModulus"
                                    : "young",
           young, "Pa"},
          {engine == Engine::rapier ? "poissonRatio"
           : is_usd                 ? "physxDeformableBodyMaterial:poissonsRatio"
                                    : "poisson",
           nu, "1"}};
}

/// The design of springs that the engine can have.
/// @throws InputError where the one that is named is no such
msm::DesignResult springs_for(const EngineFacts& facts, const EngineRequest& request,
                              msm::DesignRequest& design) {
  if (!request.has_method)
    design.options.design = msm::small_strain_material(design.material).poissons_ratio > 0.25
                                ? cases::Design::hybrid
                                : cases::Design::moduli;
  msm::DesignResult springs = msm::design(design);
  const msm::CellStiffness& k = springs.stiffness;
  if (!springs.is_of_four_stiffnesses() || (!facts.has_all_terms && (k.midline != 0 || k.exponents)))
    throw cases::InputError(fmt::format(
        "design: --for {} cannot have springs of the method {}: it takes edges, diagonals{}; "
        "--method hybrid has nothing else",
        cases::name_of(request.engine), cases::name_of(design.options.design),
        facts.has_all_terms ? ", midlines and volume terms" : " of Hooke's law and volumes of tetrahedra"));
  return springs;
}

/// A beam whose weight lowers its tip by 7 % of its length: w = rho g A L⁴/(8 E I), I/A = b²/12.
cases::Scene beam_of(const EngineDesign& design, const cases::Msm* options) {
  const double edge = design.edge, length = 10 * edge, breadth = 3 * edge, part = 0.07;
  const double gravity = part * 8 * (1e6 * design.material.youngs_modulus) * std::pow(1e-3 * breadth, 2) /
                         (12 * design.density * std::pow(1e-3 * length, 3));
  const std::string text = fmt::format(
      "schema = 1\nname = \"beam\"\n[body]\nshape = \"box\"\nsize = [{}, {}, {}]\ncells = [10, 3, 3]\n"
      "[material]\nmodel = \"linear_elastic\"\nyoungs_modulus = {}\npoissons_ratio = {}\ndensity = {}\n"
      "[[fixed]]\nregion = \"x-\"\n[[load]]\nkind = \"gravity\"\nvalue = [0.0, 0.0, -{}]\n[[measure]]\n"
      "name = \"tip\"\nkind = \"displacement\"\nnode = \"x+ y- z-\"\ncomponent = \"z\"\n[[measure]]\n"
      "name = \"everywhere\"\nkind = \"displacement_field_l2\"\n",
      length, breadth, breadth, design.material.youngs_modulus, design.material.poissons_ratio,
      design.density, gravity);
  cases::Case definition = cases::read_case_text(text, "the beam of --for");
  if (options) definition.msm = *options;
  return cases::make_scene(definition);
}

/// The engine's adapter, where it is there.
/// @return the reason why it is not, otherwise
std::string find_client(const EngineFacts& facts, const League& league, std::optional<LeagueClient>& client) {
  for (const LeagueClient& one : league.clients)
    if (one.name == facts.name) {
      const std::string file = missing(one);
      if (!file.empty())
        return file + " is not there; ./do clients installs the engines, and clients/README.md says how an "
                      "installed springproof has them";
      client = one;
      return "";
    }
  return std::string("no client of it comes with this program; ") + facts.without_client;
}

/// Tells what to expect of a row.
std::string expectation_text(const JudgedRow& row) {
  const std::string by = row.chosen.empty() ? "" : fmt::format(" ({})", one_line(row.chosen));
  if (!row.worst)
    return fmt::format("{}{} does not answer: {}{}", row.model, by, one_line(row.failure),
                       row.command.empty() ? "" : "; it was asked by: " + row.command);
  return fmt::format("{}{}: expect an error of {:.3g} % ({}){}", row.model, by, *row.worst,
                     one_line(row.worst_at), row.is_at_rest ? "" : "; it does not come to rest");
}

} // namespace

EngineDesign design_for_engine(const EngineRequest& request) {
  const EngineFacts facts = facts_of(request.engine);
  msm::DesignRequest design = request.design;
  if (!(msm::small_strain_material(design.material).poissons_ratio < 0.5))
    throw cases::InputError(
        "design: --for: the material is incompressible, must have nu below 0.5; an elastic "
        "one with --poisson 0.49 is near to it");
  const double edge = msm::cube_edge(design.cell);
  if (!(edge > 0))
    throw cases::InputError(
        "design: --for: the cell is no cube along the axes, must be one; --edge gives its "
        "edge, and export has the springs of any cells");
  EngineDesign found{request.engine,
                     msm::small_strain_material(design.material),
                     edge,
                     request.density,
                     request.budget,
                     "",
                     {},
                     {facts.cannot.begin(), facts.cannot.end()},
                     {}};
  const cases::Msm* options = nullptr;
  if (facts.takes == Takes::moduli) {
    if (request.has_method)
      throw cases::InputError(
          fmt::format("design: --for {} takes E and nu, and no springs of a method; leave "
                      "--method out",
                      cases::name_of(request.engine)));
    found.numbers = moduli_of(request.engine, found.material);
  } else {
    const msm::DesignResult springs = springs_for(facts, request, design);
    found.design = cases::name_of(design.options.design);
    found.numbers = numbers_of(facts, springs, found.edge);
    found.warnings = springs.warnings;
    options = &design.options;
  }
  if (!std::holds_alternative<cases::LinearElastic>(design.material))
    found.warnings.push_back(
        "the beam that is judged is linear elastic, with the material's moduli at small strains: "
        "what its own law adds to the error is not in it");
  found.numbers.push_back({"density", found.density, "kg/m^3"});
  found.numbers.push_back(
      {"mass of a node of eight cells", found.density * std::pow(1e-3 * found.edge, 3), "kg"});
  League league = read_league(cases::data_folder("clients") + "/league.toml");
  std::optional<LeagueClient> client;
  if (request.client) {
    client.emplace();
    client->name = request.client->name;
    client->words = request.client->words;
  } else if (request.engine == Engine::xpbd) { // ours
    client.emplace();
    client->name = cases::name_of(cases::StepMethod::xpbd);
    client->method = cases::StepMethod::xpbd;
    client->iterations = {1};
    client->substeps = {5, 20, 50};
    client->options = {{}};
  } else {
    found.not_run = find_client(facts, league, client);
  }
  if (!client) return found;
  const Judge judge(beam_of(found, options), 0);
  found.judged = judge.own(found.budget);
  std::vector<JudgedRow>& rows = found.judged->rows;
  if (request.client || found.budget.iterations > 0) {
    rows.push_back(client->method ? judge.step(steps_in(*client->method, found.budget), found.budget)
                                  : judge.ask({client->name, client->words}, found.budget));
    return found;
  }
  league.budget.step = found.budget.step;
  league.most_milliseconds = 1e3 * found.budget.step;
  for (JudgedRow& row : rows_of(judge, *client, league, [](const std::string&) {})) {
    if (row.chosen != "defaults") row.model += ", best";
    rows.push_back(std::move(row));
  }
  return found;
}

Json engine_design_to_json(const EngineDesign& design) {
  Json json{{"schema", 1},
            {"engine", cases::name_of(design.engine)},
            {"material",
             {{"youngs_modulus_MPa", design.material.youngs_modulus},
              {"poissons_ratio", design.material.poissons_ratio}}},
            {"edge_mm", design.edge},
            {"density_kg_per_m3", design.density},
            {"step_s", design.budget.step},
            {"iterations", design.budget.iterations},
            {"design", text_or_null(design.design)},
            {"numbers", json_list(design.numbers,
                                  [](const EngineNumber& one) {
                                    return Json{{"name", one.name}, {"value", one.value}, {"unit", one.unit}};
                                  })},
            {"cannot", design.cannot},
            {"warnings", design.warnings},
            {"not_run", text_or_null(design.not_run)},
            {"judged", nullptr}};
  if (design.judged) json["judged"] = judged_to_json({*design.judged}, design.budget)["cases"][0];
  return json;
}

void write_engine_design_text(std::ostream& out, const EngineDesign& design) {
  const EngineFacts facts = facts_of(design.engine);
  write_paragraph(out, fmt::format("{}{}: E = {:g} MPa, nu = {:g}, cells of {:g} mm, steps of {:.4g} ms{}",
                                   facts.name, design.design.empty() ? "" : ", springs of " + design.design,
                                   design.material.youngs_modulus, design.material.poissons_ratio,
                                   design.edge, 1e3 * design.budget.step,
                                   design.budget.iterations > 0
                                       ? fmt::format(" with {} iterations", design.budget.iterations)
                                       : ""));
  write_table(out, columns_of("number=name value{:.6g} unit{:<}"), engine_design_to_json(design)["numbers"]);
  for (const std::string& warning : design.warnings) write_paragraph(out, warning, "  warning: ", "    ");
  for (const std::string& one : design.cannot) write_paragraph(out, one, "  cannot have ", "    ");
  if (!design.judged) {
    write_paragraph(out, "error: not run: " + design.not_run);
    return;
  }
  write_judged_text(out, *design.judged);
  for (const JudgedRow& row : design.judged->rows)
    if (row.client || !row.command.empty() || !row.chosen.empty())
      write_paragraph(out, expectation_text(row));
  write_paragraph(out, "The row of springs has what their design and mesh err by.");
}

} // namespace springproof::compare
