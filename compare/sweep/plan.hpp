#pragma once

#include "cases/case/case.hpp"

namespace springproof::compare {

SPRINGPROOF_ENUMERATION(Program, springs, finite_elements, calculix)

/// Springs against everything else: what "which model is faster" is about.
enum class Family { springs, finite_elements };

/// One way to answer a case on a box: a model, its resolution, and how exactly its equations are solved, or
/// in which steps it moves.
struct Variant {
  Program program = Program::springs;
  cases::Design design{};           ///< springs
  cases::Formulation formulation{}; ///< finite elements, CalculiX
  cases::Element element{};         ///< finite elements, CalculiX
  std::array<int, 3> cells{};       ///< those of the box, along x, y, z
  double tolerance = 1e-9;          ///< on |imbalance| / |applied load|; CalculiX has its own
  double step = 0;                  ///< a motion's, s; 0: at rest
};

Family family_of(const Variant& variant);

/// The model without its resolution: "springs hybrid", "log_strain q2", "CalculiX small_strain q1".
std::string method_name(const Variant& variant);

/// "8x8x8"
std::string cells_name(const std::array<int, 3>& cells);

/// The grid on whose nodes a variant knows displacements: that of its cells, for a quadratic element of twice
/// as many.
std::array<int, 3> field_cells(const Variant& variant);

/// Method, cells and tolerance: "springs hybrid 8x2x2 to 1e-09"; of a motion "springs hybrid, 8x2x2 cells,
/// steps of 2 ms".
std::string full_name(const Variant& variant);

/// The case as a variant has it, without measures: their nodes need not exist on every mesh.
/// @param definition  its body is a box
cases::Case with_variant(const cases::Case& definition, const Variant& variant);

enum class Extent { full, quick };

/// Something that a full answer would have and this sweep has not.
struct LeftOut {
  std::string what, reason;
};

/// Levels of cells, each of twice the level before: four, of a quick sweep three. They start at half the
/// box's own cells where these are even, at its own otherwise.
std::vector<std::array<int, 3>> levels_of(const cases::Box& box, Extent extent);

/// Tolerances (in time: steps) with which a sweep solves springs.
enum class Settings { all, one };

/// A design of springs on one level.
struct SweptSprings {
  cases::Design design{};
  std::array<int, 3> cells{};
  Settings settings{};
};

/// The designs that are made from a material, each on every level. Designs of others are there to be compared
/// with: one setting is enough, and all have the sizes that those of them have that are factorised. A quick
/// sweep has one setting of every design.
/// @param left_out  what is too large is added to it
std::vector<SweptSprings> springs_to_sweep(const cases::Material& material,
                                           const std::vector<std::array<int, 3>>& levels, Extent extent,
                                           std::vector<LeftOut>& left_out);

/// What a sweep solves.
struct Plan {
  std::vector<std::array<int, 3>> levels; ///< cells, each of twice the level before
  std::vector<Variant> reference; ///< the finite-strain meshes that the truth comes from, coarse to fine
  std::vector<Variant> variants;  ///< the reference's among them
  std::vector<LeftOut> left_out;
};

/// The plan for a case: every spring design at every level and tolerance, small- and finite-strain finite
/// elements (q1, q1_bbar, q2) and CalculiX as far as their unknowns allow, on levels_of() its body.
/// @throws InputError for a body that is no box or a material without small strain
Plan plan_sweep(const cases::Case& definition, Extent extent);

} // namespace springproof::compare
