#pragma once

#include "compare/solve/answers.hpp"

/// GetFEM, an independent finite-element library, solves a case on meshes that it refines itself:
/// getfem_peer.py assembles every law of isotropic bodies with quadratic elements, and with a continuous
/// pressure where the material needs one.
namespace springproof::compare {

/// Why GetFEM cannot solve this scene; nothing if it can.
std::optional<std::string> reason_without_getfem(const cases::Scene& scene);

/// Meshes from which a limit is told with a confirmed order.
constexpr int most_getfem_meshes = 4;

/// The scene as getfem_peer.py reads it: an ArrayMessage in mm, N and MPa.
/// @param scene  one without a reason_without_getfem()
std::string getfem_scene(const cases::Scene& scene, int most_meshes = most_getfem_meshes);

/// Reads what getfem_peer.py has found, mesh by mesh.
/// @throws cases::SolveError if it did not solve the case's own mesh, or its answer is damaged
RefinedMeshes read_getfem_answer(const std::string& text, const cases::Mesh& mesh);

/// Runs getfem_peer.py in a temporary folder, one thread, on the case's mesh and refinements of it. Without
/// solutions, with the reason, when there is no GetFEM, it cannot express the case or its mesh is too large.
/// @throws cases::SolveError when it does not reach the full load
RefinedMeshes solve_with_getfem(const cases::Scene& scene, int most_meshes = most_getfem_meshes);

} // namespace springproof::compare
