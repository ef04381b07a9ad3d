#pragma once

#include "cases/case/names.hpp"

/// The designs of springs: what each is, where it comes from, and what it takes of a case file's [msm]. The
/// reader of case files, `design`, `tables`, `sweep` and `run --designs` iterate this table; msm/design has a
/// function for every row that designs from a material.
namespace springproof::cases {

SPRINGPROOF_ENUMERATION(Design, linear_method, nonlinear_method, moduli, hybrid, matched, midline, multi_load,
                        ladd_kinney, baudet, uniform, van_gelder, lloyd, biquadratic, transverse, given,
                        network)

/// The spring laws that a design goes with.
enum class DesignLaw {
  any,
  hooke,           ///< it fits Hooke's springs to curves: its stiffnesses suit no other law
  fitted,          ///< Hooke's, or power-log springs, whose exponents it fits when none are given
  power_log,       ///< it finds the exponents itself
  fitted_or_hooke, ///< power-log springs as fitted ones, or Hooke's where the case says so
  biquadratic,     ///< energies of squared lengths
  by_spring        ///< every spring has its own
};

/// What the cells of a design consist of.
enum class DesignCells {
  four_stiffnesses, ///< edges, face diagonals, internal diagonals and a volume term: the grid's kernels
                    ///< take them
  terms,            ///< others, on any mesh: assembled and factorised
  cut               ///< others, cut in mirror images from cell to cell of a grid
};

/// Where a design's stiffnesses come from.
enum class DesignSource { material, file };

/// What a design's stiffnesses follow, and so what a material must be.
enum class DesignMaterial { isotropic, transversely_isotropic, any };

/// Poisson's ratios that a design is refused for when a case is read.
struct DesignRatio {
  std::optional<double> least{}; ///< refused below
  bool is_below_half = false;    ///< refused with an incompressible material
};

struct DesignFacts {
  Design design;
  const char* what;              ///< a line
  const char* published_in;      ///< a line
  std::vector<std::string> keys; ///< keys of [msm] that this design takes and not every design
  DesignLaw law = DesignLaw::any;
  DesignSource source = DesignSource::material;
  DesignCells cells = DesignCells::four_stiffnesses;
  DesignMaterial material = DesignMaterial::isotropic;
  DesignRatio ratio{};

  /// @param differences  values of the types above, where they are others than most designs'
  template<class... Difference>
  DesignFacts(Design named, const char* described, const char* source_text, std::vector<std::string> taken,
              Difference... differences)
      : design(named), what(described), published_in(source_text), keys(std::move(taken)) {
    (set(differences), ...);
  }

 private:
  void set(DesignLaw other) { law = other; }
  void set(DesignSource other) { source = other; }
  void set(DesignCells other) { cells = other; }
  void set(DesignMaterial other) { material = other; }
  void set(DesignRatio other) { ratio = other; }
};

/// Lists the designs in the order of messages and tables.
const std::vector<DesignFacts>& all_designs();

const DesignFacts& facts_of(Design design);

/// Every key of [msm] that only some designs take.
std::vector<std::string> keys_of_designs();

bool takes(Design design, const std::string& key);

/// Whether others published the design, or ship it: a row to compare with, and none to be advised.
bool is_of_others(Design design);

/// The designs that take a key of [msm], as a message shows them: "a" | "b".
std::string designs_with(const std::string& key);

/// Whether a design is made for such a material.
bool is_for(Design design, bool is_isotropic);

/// The designs that such a material has, as a message shows them: "a" | "b".
std::string designs_for(bool is_isotropic);

} // namespace springproof::cases
