#pragma once

#include "compare/gates/comparison.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

/// Distances of the models' surfaces at landmarks; of a case without landmarks nothing.
namespace springproof::compare {

void write_landmarks_text(std::ostream& out, const Comparison& comparison);

/// [{"name", "point", "from_point", "n_rays", "mean", "deviation", "moved", "reason"}], lengths in mm.
nlohmann::ordered_json landmarks_to_json(const Comparison& comparison);

/// One row per landmark: case,landmark,x,y,z,from_point,n_rays,mean,deviation,moved; lengths in mm.
void write_landmarks_csv(std::ostream& out, const Comparison& comparison);

/// FOLDER/NAME_landmarks.csv.  @throws InputError if it cannot be written
void write_landmarks(const std::string& folder, const Comparison& comparison);

} // namespace springproof::compare
