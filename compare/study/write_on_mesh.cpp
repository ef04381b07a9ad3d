#include "cases/case/names.hpp"
#include "compare/provenance/print.hpp"
#include "compare/study/on_mesh.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace springproof::compare {

namespace {

constexpr int name_width = 17;

void write_moduli(std::ostream& out, const std::string& name, const msm::LatticeModuli& m) {
  fmt::print(out, "{:<{}}{:>11.4g}{:>9.4f}{:>11.4g}", name, name_width, m.youngs_modulus, m.poissons_ratio,
             m.shear_modulus);
}

std::string motions_text(const std::optional<FreeMotions>& motions) {
  if (!motions) return "-";
  return fmt::format("{}{}", motions->are_more ? ">= " : "", motions->n);
}

std::string percent_text(const std::optional<double>& part) {
  return part ? fmt::format("{:.3g}", 100 * *part) : "-";
}

void write_design(std::ostream& out, const DesignOnMesh& design, const MaterialOnMesh& found) {
  write_moduli(out, design.design, found.uniform);
  fmt::print(out, "{:>12}{:>9}{:>12}\n", percent_text(found.median_misfit), percent_text(found.worst_misfit),
             motions_text(design.motions));
  if (found.relaxed) {
    write_moduli(out, "  relaxed", *found.relaxed);
    fmt::print(out, "\n");
  } else {
    fmt::print(out, "  not relaxed: {}\n", found.not_relaxed);
  }
}

/// What is wrong with a free body, in a sentence each.
std::vector<std::string> doubts_of(const DesignOnMesh& design) {
  constexpr std::size_t few = 12;
  std::vector<std::string> doubts;
  if (!design.motions) return doubts;
  const FreeMotions& motions = *design.motions;
  if (motions.n > 0)
    doubts.push_back(fmt::format(
        "{}{} motions of the free body beside the rigid ones take no energy{}: supports must hold them, or a "
        "solve fails",
        motions.are_more ? "at least " : "", motions.n,
        motions.nodes.empty()         ? ""
        : motions.nodes.size() <= few ? fmt::format(", of node{} {}", motions.nodes.size() > 1 ? "s" : "",
                                                    fmt::join(motions.nodes, ", "))
                                      : fmt::format(", of {} nodes", motions.nodes.size())));
  if (motions.n_unstable > 0)
    doubts.push_back(fmt::format("{}{} motions of the free body give energy: it is unstable at rest",
                                 motions.are_more ? "at least " : "", motions.n_unstable));
  return doubts;
}

/// Each once, with the designs that it holds for.
std::vector<std::pair<std::string, std::vector<std::string>>>
all_doubts_of(const std::vector<DesignOnMesh>& designs) {
  std::vector<std::pair<std::string, std::vector<std::string>>> all;
  for (const DesignOnMesh& design : designs) {
    std::vector<std::string> doubts = doubts_of(design);
    doubts.insert(doubts.end(), design.warnings.begin(), design.warnings.end());
    for (const std::string& text : doubts) {
      const auto known =
          std::find_if(all.begin(), all.end(), [&](const auto& other) { return other.first == text; });
      if (known == all.end())
        all.push_back({text, {design.design}});
      else
        known->second.push_back(design.design);
    }
  }
  return all;
}

Json material_to_json(const MaterialOnMesh& found) {
  const auto percent = [](const std::optional<double>& part) {
    return part ? Json(100 * *part) : Json(nullptr);
  };
  return {{"cells", found.n_cells},
          {"inner_nodes", found.n_inner},
          {"material_moduli", found.wanted ? moduli_to_json(*found.wanted) : Json(nullptr)},
          {"moduli", moduli_to_json(found.uniform)},
          {"relaxed_moduli", found.relaxed ? moduli_to_json(*found.relaxed) : Json(nullptr)},
          {"not_relaxed", found.relaxed ? Json(nullptr) : Json(found.not_relaxed)},
          {"median_misfit_percent", percent(found.median_misfit)},
          {"worst_misfit_percent", percent(found.worst_misfit)}};
}

} // namespace

Json moduli_to_json(const msm::LatticeModuli& m) {
  return {{"C11", m.c11},
          {"C12", m.c12},
          {"C44", m.c44},
          {"zener", m.zener},
          {"youngs_modulus", m.youngs_modulus},
          {"poissons_ratio", m.poissons_ratio},
          {"shear_modulus", m.shear_modulus}};
}

void write_on_mesh_text(std::ostream& out, const SpringsOnMesh& study) {
  const auto& designs = study.designs;
  const auto first = std::find_if(designs.begin(), designs.end(),
                                  [](const DesignOnMesh& design) { return design.refusal.empty(); });
  const bool is_of_tetrahedra = study.scene.mesh.shape == cases::CellShape::tetrahedron;
  print(out, "{}: {} {}, {} nodes; nothing is solved\n", study.scene.definition.name,
        study.scene.mesh.cells.size(), is_of_tetrahedra ? "tetrahedra" : "hexahedra",
        study.scene.mesh.nodes.size());
  const std::size_t n_materials = first == designs.end() ? 0 : first->materials.size();
  for (std::size_t m = 0; m < n_materials; ++m) {
    const MaterialOnMesh& cells = first->materials[m];
    if (cells.n_cells == 0) continue;
    fmt::print(out, "\n");
    if (n_materials > 1)
      fmt::print(out, "material {} of {}: {} cells, {} nodes inside\n", m + 1, n_materials, cells.n_cells,
                 cells.n_inner);
    fmt::print(out, "{:<{}}{:>11}{:>9}{:>11}{:>12}{:>9}{:>12}\n", "", name_width, "E MPa", "nu", "G MPa",
               "misfit %", "worst", "zero modes");
    if (cells.wanted) {
      write_moduli(out, "the material", *cells.wanted);
      fmt::print(out, "\n");
    }
    for (const DesignOnMesh& design : designs)
      if (design.refusal.empty()) write_design(out, design, design.materials[m]);
  }
  for (const DesignOnMesh& design : designs)
    if (!design.refusal.empty())
      fmt::print(out, "{:<{}}{}\n", design.design, name_width,
                 in_short(one_line("refused: " + design.refusal), screen_width - name_width));
  if (first == designs.end()) return;
  fmt::print(out, "\n");
  write_paragraph(out,
                  "A design's moduli are those of a uniform strain that every node follows; relaxed, the "
                  "nodes inside find their equilibrium. Misfit: of the energies of strains in the median "
                  "and in the worst cell. Zero modes: motions of the free body without energy, beside "
                  "the rigid ones.");
  for (const auto& [text, names] : all_doubts_of(designs))
    write_paragraph(out, text, fmt::format("warning: {}: ", fmt::join(names, ", ")), "         ");
}

Json on_mesh_to_json(const SpringsOnMesh& study) {
  Json designs = Json::array();
  for (const DesignOnMesh& design : study.designs) {
    if (!design.refusal.empty()) {
      designs.push_back({{"design", design.design}, {"refused", design.refusal}});
      continue;
    }
    Json materials = Json::array();
    for (const MaterialOnMesh& found : design.materials) materials.push_back(material_to_json(found));
    Json motions = nullptr;
    if (design.motions)
      motions = {{"n", design.motions->n},
                 {"are_more", design.motions->are_more},
                 {"unstable", design.motions->n_unstable},
                 {"nodes", design.motions->nodes}};
    designs.push_back({{"design", design.design},
                       {"springs", design.springs},
                       {"materials", materials},
                       {"zero_modes", motions},
                       {"warnings", design.warnings}});
  }
  return {{"case", study.scene.definition.name},
          {"shape", cases::name_of(study.scene.mesh.shape)},
          {"body", body_to_json(study.scene)},
          {"designs", designs}};
}

} // namespace springproof::compare
