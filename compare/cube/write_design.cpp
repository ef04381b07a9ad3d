#include "compare/cube/write_design.hpp"

#include "compare/write/csv.hpp"
#include "compare/write/gnuplot.hpp"
#include "compare/write/json.hpp"
#include "compare/write/springs_text.hpp"

#include <array>
#include <fmt/ostream.h>
#include <utility>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

/// The ends of stable stretch, compression and simple shear. An end of the search is a bound, not a limit
/// that was found.
std::array<std::string, 3> limits(const std::optional<msm::StabilityRange>& range) {
  if (!range) return {"-", "-", "-"};
  const auto limit = [](double found, double end) {
    return found == end ? fmt::format("beyond {:.2f}", end) : fmt::format("{:.3f}", found);
  };
  return {limit(range->stretch, msm::search_ends.stretch),
          limit(range->compression, msm::search_ends.compression),
          limit(range->shear, msm::search_ends.shear)};
}

std::array<double, 3> newton_per_metre(const msm::CellStiffness& k) {
  return {1e3 * k.edge, 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal};
}

std::array<double, 3> exponents_of(const msm::Exponents& p) {
  return {p.edge, p.face_diagonal, p.internal_diagonal};
}

/// For either load set a column per measure, then what they come to.
void write_cube_errors(std::ostream& out, const std::vector<DesignAttempt>& attempts) {
  for (const auto& [name, load_set] :
       {std::pair("small", &CubeErrors::small), std::pair("large", &CubeErrors::large)}) {
    bool is_first = true;
    for (const DesignAttempt& a : attempts) {
      if (!a.cube) continue;
      const LoadSetErrors& errors = (*a.cube).*load_set;
      if (std::exchange(is_first, false)) {
        fmt::print(out, "\nerrors on the cube under {} loads, %\n{:<17}", name, "");
        for (const CubeError& m : errors.measures) fmt::print(out, "{:>10}", m.measure);
        fmt::print(out, "{:>8}{:>8}{:>8}\n", "worst", "mean", "stable");
      }
      fmt::print(out, "{:<17}", a.name);
      for (const CubeError& m : errors.measures)
        fmt::print(out, "{:>10}", m.error_percent ? fmt::format("{:+.2f}", *m.error_percent) : "failed");
      for (const auto& of_all : {errors.worst, errors.mean})
        fmt::print(out, "{:>8}", of_all ? fmt::format("{:.2f}", *of_all) : "-");
      fmt::print(out, "{:>8}\n", errors.is_stable ? "yes" : "NO");
    }
  }
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

/// In place of the moduli that a cubic lattice has.
void write_fibre_lattice(std::ostream& out, const msm::NearestModuli& lattice) {
  const mechanics::TransverseModuli& c = lattice.moduli;
  const cases::TransverselyIsotropic m = mechanics::engineering_constants(c);
  fmt::print(
      out,
      "  lattice          C11 {:.6g}, C12 {:.6g}, C13 {:.6g}, C33 {:.6g}, C44 {:.6g}, C66 {:.6g} MPa, 3 "
      "along the fibre\n",
      c.c11, c.c12, c.c13, c.c33, c.c44, c.c66);
  fmt::print(out, "  along the fibre  E {:.6g} MPa, nu {:.4f}, G {:.6g} MPa\n", m.youngs_modulus_along,
             m.poissons_ratio_along, m.shear_modulus_along);
  fmt::print(out, "  across it        E {:.6g} MPa, nu {:.4f}, G {:.6g} MPa\n", m.youngs_modulus_across,
             m.poissons_ratio_across, c.c66);
  fmt::print(out, "  misfit           the energies of strains err by up to {:.3g} %\n", 100 * lattice.misfit);
}

Json moduli_to_json(const msm::DesignResult& design) {
  if (!design.by_fibre) {
    const msm::LatticeModuli& m = design.moduli;
    return {{"C11", m.c11},
            {"C12", m.c12},
            {"C44", m.c44},
            {"zener", m.zener},
            {"youngs_modulus", m.youngs_modulus},
            {"poissons_ratio", m.poissons_ratio},
            {"shear_modulus", m.shear_modulus}};
  }
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

} // namespace

void write_design_text(std::ostream& out, const DesignAttempt& attempt) {
  const msm::DesignResult& design = *attempt.design;
  const msm::CellStiffness& k = design.stiffness;
  const msm::LatticeModuli& m = design.moduli;
  const cases::DesignFacts& facts = cases::facts_of(attempt.options.design);
  fmt::print(out, "{}: {} ({})\n", attempt.name, facts.what, facts.published_in);
  if (design.terms)
    fmt::print(out, "  springs          {}\n", springs_text(design));
  else
    fmt::print(out, "  k_e, k_f, k_d    {:.6g} N/m\n", fmt::join(newton_per_metre(k), ", "));
  if (k.volume != 0) fmt::print(out, "  k_v              {:.6g} MPa\n", k.volume);
  if (k.exponents)
    fmt::print(out, "  exponents        {:.6g}\n", fmt::join(exponents_of(*k.exponents), ", "));
  if (design.residual) fmt::print(out, "  residual         {:.6g}\n", *design.residual);
  if (design.by_fibre)
    write_fibre_lattice(out, *design.by_fibre);
  else
    fmt::print(out,
               "  lattice          C11 {:.6g}, C12 {:.6g}, C44 {:.6g} MPa, Zener ratio {:.4f}\n"
               "  along its axes   E {:.6g} MPa, nu {:.4f}, G {:.6g} MPa\n",
               m.c11, m.c12, m.c44, m.zener, m.youngs_modulus, m.poissons_ratio, m.shear_modulus);
  if (attempt.stability) {
    const auto [stretch, compression, shear] = limits(attempt.stability);
    fmt::print(out, "  stable           stretch to {}, compression to {}, simple shear to {}\n", stretch,
               compression, shear);
  }
  for (const std::string& warning : design.warnings) fmt::print(out, "  WARNING: {}\n", warning);
  write_cube_errors(out, {attempt});
}

void write_comparison_text(std::ostream& out, const std::vector<DesignAttempt>& attempts) {
  fmt::print(out, "{:<17}{:>9}{:>8}{:>8}{:>9}{:>9}{:>8}{:>9}{:>8}{:>12}{:>13}{:>13}\n", "method", "k_e N/m",
             "k_f", "k_d", "k_v MPa", "E MPa", "nu", "G MPa", "Zener", "residual", "stretch", "compression");
  for (const DesignAttempt& a : attempts) {
    if (!a.design) {
      fmt::print(out, "{:<17}refused: {}\n", a.name, a.refusal);
      continue;
    }
    const msm::CellStiffness& k = a.design->stiffness;
    const msm::LatticeModuli& m = a.design->moduli;
    const auto [edge, face, internal] = newton_per_metre(k);
    const auto [stretch, compression, shear] = limits(a.stability);
    if (a.design->by_fibre) {
      fmt::print(out, "{}\n", a.name);
      write_fibre_lattice(out, *a.design->by_fibre);
    } else if (a.design->terms)
      fmt::print(out, "{:<17}{:>34}{:>9.4g}{:>8.4f}{:>9.4f}{:>8.3f}{:>12}{:>13}{:>13}\n", a.name, "",
                 m.youngs_modulus, m.poissons_ratio, m.shear_modulus, m.zener, "-", stretch, compression);
    else
      fmt::print(out,
                 "{:<17}{:>9.4g}{:>8.4g}{:>8.4g}{:>9.4g}{:>9.4g}{:>8.4f}{:>9.4f}{:>8.3f}{:>12}{:>13}{:>13}\n",
                 a.name, edge, face, internal, k.volume, m.youngs_modulus, m.poissons_ratio, m.shear_modulus,
                 m.zener, a.design->residual ? fmt::format("{:.4g}", *a.design->residual) : "-", stretch,
                 compression);
    if (k.exponents)
      fmt::print(out, "{:<17}exponents {:.4g}\n", "", fmt::join(exponents_of(*k.exponents), ", "));
    if (a.design->terms) fmt::print(out, "{:<17}{}\n", "", springs_text(*a.design));
    for (const std::string& warning : a.design->warnings) fmt::print(out, "  WARNING: {}\n", warning);
  }
  write_cube_errors(out, attempts);
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
                {"moduli", moduli_to_json(design)},
                {"warnings", design.warnings},
                {"stability", nullptr}};
  document.update(springs_to_json(design));
  if (attempt.stability) {
    document["stability"] = range_to_json(*attempt.stability);
    document["stability"]["searched"] = range_to_json(msm::search_ends);
  }
  if (attempt.cube) document["cube"] = cube_to_json(*attempt.cube);
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
