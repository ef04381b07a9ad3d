#pragma once

#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// What solving a question takes, in units of its own: it decides an order alone.
double estimated_cost(const Question& question);

} // namespace springproof::compare
