#pragma once

#include "compare/gates/comparison.hpp"

#include <ostream>

namespace springproof::compare {

/// What a run's text has of the mesh study.
enum class MeshTable { left_out, printed };

/// Body, loads, both sides, warnings, the peer, measures and expectations, in lines of at most 100 columns.
/// The verdict comes after it: write_verdict_text() of compare/ranking.
void write_text(std::ostream& out, const Comparison& comparison, MeshTable meshes = MeshTable::left_out);

} // namespace springproof::compare
