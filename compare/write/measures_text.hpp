#pragma once

#include "compare/gates/comparison.hpp"

#include <ostream>

namespace springproof::compare {

/// Whether a measure's error is the norm of a difference, of fields over the body or of courses over time; it
/// has no sign.
bool is_norm(const MeasuredValue& measured, const cases::Case& definition);

/// One line a measure: both models, the limit where there is one, the errors against it and of the finite
/// elements themselves. Then what the errors are against, and why values are missing.
void write_measures_text(std::ostream& out, const Comparison& comparison);

/// The finite elements' values on every mesh, with orders and error bars. In a terminal's width the finest
/// meshes alone.
void write_mesh_study_text(std::ostream& out, const MeshStudy& study);

} // namespace springproof::compare
