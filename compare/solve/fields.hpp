#pragma once

#include "cases/scene/fields.hpp"
#include "compare/solve/answers.hpp"

/// The fields of answers, for cereal: see cases/mesh/fields.hpp.
namespace cereal {

SPRINGPROOF_FIELDS(springproof::msm::Exponents, by_kind, law)
SPRINGPROOF_FIELDS(springproof::msm::SpringLaw, kind, parameter)
SPRINGPROOF_FIELDS(springproof::msm::CellStiffness, edge, face_diagonal, internal_diagonal, volume, midline,
                   exponents)
SPRINGPROOF_FIELDS(springproof::msm::LatticeModuli, c11, c12, c44, zener, youngs_modulus, poissons_ratio,
                   shear_modulus)
SPRINGPROOF_FIELDS(springproof::msm::CellSpring, vertices, stiffness, law)
SPRINGPROOF_FIELDS(springproof::msm::CellTetrahedron, vertices, lambda, mu)
SPRINGPROOF_FIELDS(springproof::msm::CellMidline, axis, stiffness, law)
SPRINGPROOF_FIELDS(springproof::msm::CellTerms, springs, tetrahedra, midlines, volume, is_logarithmic,
                   is_at_nodes)
SPRINGPROOF_FIELDS(springproof::msm::BodyTerms, kinds, kind_of_cell, boundary, planes_of_node)
SPRINGPROOF_FIELDS(springproof::msm::SpringBody, kind)
SPRINGPROOF_FIELDS(springproof::mechanics::TransverseModuli, c11, c12, c13, c33, c44, c66, bulk_modulus)
SPRINGPROOF_FIELDS(springproof::msm::NearestModuli, moduli, distance, misfit)
SPRINGPROOF_FIELDS(springproof::msm::ModuliMisfit, largest, text)
SPRINGPROOF_FIELDS(springproof::msm::DesignResult, stiffness, residual, moduli, warnings, springs, by_fibre,
                   misfit)
SPRINGPROOF_FIELDS(springproof::compare::Answer, solution, setup_seconds, solve_seconds)
SPRINGPROOF_FIELDS(springproof::compare::RefinedMeshes, refine, solutions, reason)
SPRINGPROOF_FIELDS(springproof::compare::Peer, program, answer, largest_difference)
SPRINGPROOF_FIELDS(springproof::compare::Interpolated, side, n_points, n_outside, largest_distance,
                   fem_and_back)
SPRINGPROOF_FIELDS(springproof::compare::Answers, resolved, choices, fem, msm, msm_source, msm_name, design,
                   refined, peer, interpolated, msm_warnings)
SPRINGPROOF_FIELDS(springproof::compare::Request, only, meshes, peer, n_threads)
SPRINGPROOF_FIELDS(springproof::compare::Question, scene, request)

} // namespace cereal
