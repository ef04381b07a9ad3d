#include "compare/cube/write_design.hpp"

#include "cases/case/readers.hpp"
#include "compare/provenance/print.hpp"
#include "compare/study/on_mesh.hpp"
#include "compare/table/table.hpp"
#include "compare/write/gnuplot.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/ostream.h>
#include <utility>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

/// The ends of stable stretch, compression and simple shear. An end of the search is a bound, not a limit
/// that was found.
/// @param beyond  what stands before a bound: of a stretch, a compression, a shear
std::array<std::string, 3> limits(const std::optional<msm::StabilityRange>& range,
                                  const std::array<const char*, 3>& beyond) {
  if (!range) return {"-", "-", "-"};
  const auto limit = [](double found, double end, const char* before) {
    return found == end ? fmt::format("{}{:.2f}", before, end) : fmt::format("{:.3f}", found);
  };
  return {limit(range->stretch, msm::search_ends.stretch, beyond[0]),
          limit(range->compression, msm::search_ends.compression, beyond[1]),
          limit(range->shear, msm::search_ends.shear, beyond[2])};
}

bool is_volume(const CubeError& m) {
  return m.measure == "volume";
}

void write_row_of_errors(std::ostream& out, const std::string& name, const LoadSetErrors& errors) {
  const auto digits = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.2f}", *value) : "-";
  };
  fmt::print(out, "{:<17}", name);
  for (const CubeError& m : errors.measures)
    if (!is_volume(m))
      fmt::print(out, "{:>8}", m.error_percent ? fmt::format("{:+.2f}", *m.error_percent) : "failed");
  fmt::print(out, "{:>8}{:>8}{:>8}{:>8}\n", digits(errors.worst), digits(errors.mean),
             digits(errors.worst_volume), errors.is_stable ? "yes" : "no");
  if (!errors.failure.empty())
    fmt::print(out, "{:<17}{}\n", "", in_short(one_line(errors.failure), screen_width - 17));
}

/// Writes, for either load set, a column per measure and what they come to; volumes by their worst alone.
void write_cube_errors(std::ostream& out, const std::vector<DesignAttempt>& attempts) {
  for (const auto& [name, load_set] :
       {std::pair("small", &CubeErrors::small), std::pair("large", &CubeErrors::large)}) {
    bool is_first = true;
    for (const DesignAttempt& a : attempts) {
      if (!a.cube) continue;
      const LoadSetErrors& errors = (*a.cube).*load_set;
      if (std::exchange(is_first, false)) {
        fmt::print(out, "\nerrors on the cube under {} loads, %\n{:<17}", name, "");
        for (const CubeError& m : errors.measures)
          if (!is_volume(m)) fmt::print(out, "{:>8}", m.measure);
        fmt::print(out, "{:>8}{:>8}{:>8}{:>8}\n", "worst", "mean", "volume", "stable");
      }
      write_row_of_errors(out, a.name, errors);
    }
  }
  for (const DesignAttempt& a : attempts)
    if (a.has_law_of_cube)
      write_paragraph(out,
                      a.name + ": measured with Hooke's springs, which it has above nu = 0.35 in a case of "
                               "forces on nodes, such as the cube's",
                      "", "  ");
}

void write_warnings(std::ostream& out, const msm::DesignResult& design) {
  for (const std::string& warning : design.warnings)
    write_paragraph(out, warning, "  warning: ", "           ");
}

Json range_to_json(const msm::StabilityRange& range) {
  return {{"stretch", range.stretch}, {"compression", range.compression}, {"simple_shear", range.shear}};
}

Json cube_to_json(const CubeErrors& cube) {
  Json measures = Json::array();
  for (const LoadSetErrors* errors : {&cube.small, &cube.large})
    for (const CubeError& m : errors->measures) {
      measures.push_back({{"case", m.test}, {"measure", m.measure}, {"error_percent", m.error_percent}});
      if (!m.error_percent) measures.back()["message"] = m.message;
    }
  return {{"worst_error_percent", cube.worst()}, {"worst_volume_error_percent", cube.worst_volume()},
          {"stable", cube.is_stable()},          {"small", errors_to_json(cube.small)},
          {"large", errors_to_json(cube.large)}, {"measures", measures}};
}

/// Writes a lattice's moduli by its fibre, where a cubic lattice's would stand.
void write_fibre_lattice(std::ostream& out, const msm::NearestModuli& lattice) {
  const mechanics::TransverseModuli& c = lattice.moduli;
  const cases::TransverselyIsotropic m = mechanics::engineering_constants(c);
  fmt::print(out,
             "  lattice, MPa     C11 {:.6g}, C12 {:.6g}, C13 {:.6g}, C33 {:.6g}, C44 {:.6g}, C66 {:.6g}\n"
             "                   (3 is along the fibre)\n",
             c.c11, c.c12, c.c13, c.c33, c.c44, c.c66);
  fmt::print(out, "  along the fibre  E {:.6g} MPa, nu {:.4f}, G {:.6g} MPa\n", m.youngs_modulus_along,
             m.poissons_ratio_along, m.shear_modulus_along);
  fmt::print(out, "  across it        E {:.6g} MPa, nu {:.4f}, G {:.6g} MPa\n", m.youngs_modulus_across,
             m.poissons_ratio_across, c.c66);
  fmt::print(out, "  misfit           the energies of strains err by up to {:.3g} %\n", 100 * lattice.misfit);
}

Json design_moduli_to_json(const msm::DesignResult& design) {
  if (!design.by_fibre) return moduli_to_json(design.moduli);
  const mechanics::TransverseModuli& c = design.by_fibre->moduli;
  const cases::TransverselyIsotropic m = mechanics::engineering_constants(c);
  return {{"C11", c.c11},
          {"C12", c.c12},
          {"C13", c.c13},
          {"C33", c.c33},
          {"C44", c.c44},
          {"C66", c.c66},
          {"youngs_modulus_along", m.youngs_modulus_along},
          {"youngs_modulus_across", m.youngs_modulus_across},
          {"poissons_ratio_along", m.poissons_ratio_along},
          {"poissons_ratio_across", m.poissons_ratio_across},
          {"shear_modulus_along", m.shear_modulus_along},
          {"misfit_percent", 100 * design.by_fibre->misfit}};
}

/// A design's stiffnesses and its lattice's moduli on one line.
void write_compared(std::ostream& out, const DesignAttempt& a) {
  const std::string indent(17, ' ');
  if (!a.design) return write_paragraph(out, "refused: " + a.refusal, fmt::format("{:<17}", a.name), indent);
  const msm::CellStiffness& k = a.design->stiffness;
  const msm::LatticeModuli& m = a.design->moduli;
  const auto [stretch, compression, shear] = limits(a.stability, {">", "<", ">"}); // in a column
  if (a.design->by_fibre) {
    fmt::print(out, "{}\n", a.name);
    write_fibre_lattice(out, *a.design->by_fibre);
  } else {
    const std::string springs = a.design->springs.terms()
                                    ? ""
                                    : fmt::format("{:>9.4g}{:>8.4g}{:>8.4g}{:>9.4g}", 1e3 * k.edge,
                                                  1e3 * k.face_diagonal, 1e3 * k.internal_diagonal, k.volume);
    fmt::print(out, "{:<17}{:>34}{:>9.4g}{:>8.4f}{:>9.4f}{:>7.3f}{:>8}{:>8}\n", a.name, springs,
               m.youngs_modulus, m.poissons_ratio, m.shear_modulus, m.zener, stretch, compression);
  }
  if (k.midline != 0) fmt::print(out, "{}k_m {:.4g} N/m\n", indent, 1e3 * k.midline);
  if (k.exponents) fmt::print(out, "{}exponents {:.4g}\n", indent, fmt::join(k.exponents->by_kind, ", "));
  if (a.design->springs.terms()) write_paragraph(out, springs_text(*a.design), indent, indent);
  write_warnings(out, *a.design);
}

/// The measured attempts that are stable in every test, but one.
std::vector<DesignAttempt> rivals_of(const DesignAttempt& best, const std::vector<DesignAttempt>& attempts) {
  std::vector<DesignAttempt> rivals;
  for (const DesignAttempt& a : attempts)
    if (&a != &best && a.cube && a.cube->standing().worst) rivals.push_back(a);
  return rivals;
}

/// "alpha_1 under large loads": where the worst error is.
std::string place_of_worst(const CubeErrors& cube) {
  for (const auto& [name, errors] : {std::pair("small", &cube.small), std::pair("large", &cube.large)})
    for (const CubeError& m : errors->measures)
      if (m.error_percent && std::abs(*m.error_percent) == cube.worst())
        return fmt::format("{} under {} loads", m.measure, name);
  return "";
}

/// What speaks for the design without a name.
std::string reason_for(const DesignAttempt& by_default, const DesignAttempt& best) {
  const auto strain = [](const DesignAttempt& a) { return a.stability ? stable_strain(*a.stability) : 0; };
  if (!(strain(by_default) > strain(best)))
    return "its rule asks for a large lattice that stays stable, not for this cube alone";
  return fmt::format("its lattice is stable to logarithmic strains of {:.2f}, that of {} to {:.2f}",
                     strain(by_default), best.name, strain(best));
}

std::string default_text(const DesignAttempt& best, const std::vector<DesignAttempt>& attempts,
                         const msm::DesignRequest& request) {
  const auto default_name = [&](bool has_nodal_forces) {
    return cases::name_of(
        cases::default_design({request.material}, request.options.poissons_ratio, has_nodal_forces));
  };
  const std::string name = default_name(true), other = default_name(false);
  const std::string without_forces =
      other == name ? ""
                    : fmt::format(" A case without them takes {}, which is nearer to the limit of fine "
                                  "meshes: these forces have none.",
                                  other);
  if (name == best.name)
    return " A case of forces on nodes, like the cube's, that names no design takes it too." + without_forces;
  for (const DesignAttempt& a : attempts)
    if (a.name == name && a.cube && a.cube->worst())
      return fmt::format(" A case of forces on nodes, like the cube's, that names no design takes {}, with "
                         "{:.2f} %: {}.",
                         name, *a.cube->worst(), reason_for(a, best)) +
             without_forces;
  return fmt::format(" A case of forces on nodes that names no design takes {}.", name) + without_forces;
}

} // namespace

void write_design_text(std::ostream& out, const DesignAttempt& attempt) {
  const msm::DesignResult& design = *attempt.design;
  const msm::CellStiffness& k = design.stiffness;
  const msm::LatticeModuli& m = design.moduli;
  const cases::DesignFacts& facts = cases::facts_of(attempt.options.design);
  write_paragraph(out, fmt::format("{}: {} ({})", attempt.name, facts.what, facts.published_in), "", "  ");
  if (design.springs.terms())
    write_paragraph(out, springs_text(design), "  springs          ", std::string(19, ' '));
  else
    fmt::print(out, "  k_e, k_f, k_d    {:.6g} N/m\n", fmt::join(scaled(k, 1e3).springs(), ", "));
  if (k.volume != 0) fmt::print(out, "  k_v              {:.6g} MPa\n", k.volume);
  if (k.midline != 0)
    fmt::print(out, "  k_m              {:.6g} N/m, {}\n", 1e3 * k.midline,
               attempt.options.beta ? fmt::format("beta = {:g}", *attempt.options.beta)
                                    : "where a body is many cells thick (beta = 0.8)");
  if (k.exponents) fmt::print(out, "  exponents        {:.6g}\n", fmt::join(k.exponents->by_kind, ", "));
  if (design.residual) fmt::print(out, "  residual         {:.6g}\n", *design.residual);
  if (design.by_fibre)
    write_fibre_lattice(out, *design.by_fibre);
  else
    fmt::print(out,
               "  lattice          C11 {:.6g}, C12 {:.6g}, C44 {:.6g} MPa, Zener ratio {:.4f}\n"
               "  along its axes   E {:.6g} MPa, nu {:.4f}, G {:.6g} MPa\n",
               m.c11, m.c12, m.c44, m.zener, m.youngs_modulus, m.poissons_ratio, m.shear_modulus);
  if (attempt.stability) {
    const auto [stretch, compression, shear] = limits(attempt.stability, {"beyond ", "beyond ", "beyond "});
    fmt::print(out, "  stable           stretch to {}, compression to {}, simple shear to {}\n", stretch,
               compression, shear);
  }
  write_warnings(out, design);
  write_cube_errors(out, {attempt});
}

void write_comparison_text(std::ostream& out, const std::vector<DesignAttempt>& attempts) {
  fmt::print(out, "{:<17}{:>9}{:>8}{:>8}{:>9}{:>9}{:>8}{:>9}{:>7}{:>8}{:>8}\n", "method", "k_e N/m", "k_f",
             "k_d", "k_v MPa", "E MPa", "nu", "G MPa", "Zener", "longer", "shorter");
  for (const DesignAttempt& a : attempts) write_compared(out, a);
  fmt::print(out, "longer, shorter: stretches along an axis to which the lattice is stable\n");
  write_cube_errors(out, attempts);
}

std::string recommendation_text(const std::vector<DesignAttempt>& attempts,
                                const msm::DesignRequest& request) {
  const DesignAttempt* best = recommended(attempts);
  if (!best) return "None is recommended: no design is stable in every test of the cube.";
  const cases::LinearElastic material = msm::small_strain_material(request.material);
  std::string text = fmt::format(
      "Use {} for E = {:.4g} MPa and nu = {:.4g}: its worst error on the thesis's cube is {:.2f} % ({}), its "
      "worst volume error {:.2f} %.",
      best->name, material.youngs_modulus, request.options.poissons_ratio.value_or(material.poissons_ratio),
      *best->cube->worst(), place_of_worst(*best->cube), best->cube->worst_volume().value_or(0));
  const std::vector<DesignAttempt> rivals = rivals_of(*best, attempts);
  if (const DesignAttempt* next = recommended(rivals))
    text +=
        fmt::format(" That is the smallest of the {} designs that are stable in every test; the next is {} "
                    "with {:.2f} %.",
                    rivals.size() + 1, next->name, *next->cube->worst());
  return text + default_text(*best, attempts, request);
}

Json errors_to_json(const LoadSetErrors& errors) {
  return {{"worst_error_percent", errors.worst},
          {"mean_error_percent", errors.mean},
          {"worst_volume_error_percent", errors.worst_volume},
          {"stable", errors.is_stable}};
}

Json attempt_to_json(const DesignAttempt& attempt) {
  if (!attempt.design) return {{"method", attempt.name}, {"refused", attempt.refusal}};
  const msm::DesignResult& design = *attempt.design;
  const cases::DesignFacts& facts = cases::facts_of(attempt.options.design);
  Json document{{"method", attempt.name},
                {"what", facts.what},
                {"published_in", facts.published_in},
                {"residual", design.residual},
                {"moduli", design_moduli_to_json(design)},
                {"warnings", design.warnings},
                {"stability", nullptr}};
  document.update(springs_to_json(design));
  if (attempt.stability) {
    document["stability"] = range_to_json(*attempt.stability);
    document["stability"]["searched"] = range_to_json(msm::search_ends);
  }
  if (attempt.cube) {
    document["cube"] = cube_to_json(*attempt.cube);
    document["cube"]["has_hooke_springs"] = attempt.has_law_of_cube;
  }
  return document;
}

namespace {

/// Kinds of cells that differ; 0 where all are alike, and for a network.
std::size_t n_kinds(const msm::SpringBody& springs) {
  if (springs.terms()) return springs.terms()->kinds.size();
  return springs.cells() && springs.cells()->size() > 1 ? springs.cells()->size() : 0;
}

} // namespace

Json springs_of_case(const Comparison& comparison) {
  const auto& design = comparison.answers.design;
  if (!design || !comparison.answers.msm_source.empty()) return nullptr;
  const cases::Msm& options = comparison.scene.definition.msm;
  const bool is_network = options.design == cases::Design::network; // without cells
  const bool has_cube = !is_network && comparison.scene.mesh.shape == cases::CellShape::hexahedron;
  const std::string name = cases::name_of(options.design);
  Json document = attempt_to_json(
      has_cube ? attempt_of(name, *design, options, cases::cell_vertices(comparison.scene.mesh, 0))
               : DesignAttempt{name, design, {}, {}, {}, options});
  document["design"] = name;
  document["kinds_of_cells"] = n_kinds(design->springs);
  if (is_network) document["moduli"] = nullptr;
  return document;
}

void plot_pareto_front(const std::string& folder, const std::vector<DesignAttempt>& attempts) {
  const std::vector<bool> front = on_pareto_front(attempts);
  const auto write = [&](CsvWriter& csv) {
    csv.row("# design", "worst_error_percent", "stable_strain", "on_front");
    for (std::size_t i = 0; i < attempts.size(); ++i)
      if (const DesignAttempt& a = attempts[i]; a.cube && a.cube->worst() && a.stability)
        csv.row(a.name, a.cube->worst(), stable_strain(*a.stability), front[i] ? 1 : 0);
  };
  write_csv_file(folder + "/pareto.csv", write, 6);
  draw(folder, "pareto", "pareto", {{"width", 900.}});
}

} // namespace springproof::compare
