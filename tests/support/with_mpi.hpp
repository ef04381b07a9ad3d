#pragma once

#include "compare/solve/solvers.hpp"

/// Starts MPI, PETSc and SLEPc before a test that calls them itself: TEST_CASE_METHOD(WithMpi, "...").
struct WithMpi {
  WithMpi() { springproof::compare::solvers(); }
};
