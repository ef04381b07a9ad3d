#pragma once

#include "cases/mesh/vtk.hpp"
#include "compare/gates/comparison.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

/// One plain record (Comparison), many writers.
namespace springproof::compare {

void write_text(std::ostream& out, const Comparison& comparison);

/// A table of values, orders and error bars, or the one reason why there is none.
void write_text(std::ostream& out, const MeshStudy& study);

/// Adds to a finite-element side "discretisation_error_percent" (by measure, null where there is none), and
/// "mesh_study" with the values behind it and the reasons.
void add_mesh_study(nlohmann::ordered_json& side, const MeshStudy& study);

/// One line: what became of the peer, and how far it is from the finite elements.
void write_text(std::ostream& out, const Peer& peer);

nlohmann::ordered_json to_json(const Peer& peer);

/// What every document of results begins with: schema, program and machine.
nlohmann::ordered_json provenance();

/// The solution of one side and what it took.
nlohmann::ordered_json side_to_json(const Answer& side);

/// The document of `run --json`: schema, program, machine and the cases. Keys stay in the order written.
nlohmann::ordered_json to_json(const std::vector<Comparison>& comparisons);

/// One row per case and measure: case,measure,unit,fem,msm,error_percent,fem_status,msm_status,
/// fem_discretisation_error_percent,peer; empty where there is no value.
void write_csv(std::ostream& out, const std::vector<Comparison>& comparisons);

/// The body's mesh as a VTK unstructured grid (.vtu, raw binary) with the displacements and cell volumes of
/// the sides that converged, and their difference: ParaView's "warp by vector" overlays both models. Doubles,
/// mm and mm³.
void write_vtu(std::ostream& out, const Comparison& comparison);

/// Any vectors on a mesh's nodes as a .vtu.
void write_vtu(std::ostream& out, const cases::HexMesh& mesh, const std::vector<cases::PointField>& fields);

} // namespace springproof::compare
