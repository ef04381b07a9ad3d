#include "mechanics/petsc/handles.hpp"

#include <stdexcept>
#include <string>

namespace springproof::mechanics::petsc {

void check(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw std::runtime_error(std::string("PETSc: ") + (text != nullptr ? text : "unknown error"));
}

Vector like(const Vector& vector) {
  Vec copy = nullptr;
  check(VecDuplicate(vector.get(), &copy));
  Vector owned(copy);
  check(VecSet(copy, 0));
  return owned;
}

void update_ghosts(Vec vector) {
  check(VecGhostUpdateBegin(vector, INSERT_VALUES, SCATTER_FORWARD));
  check(VecGhostUpdateEnd(vector, INSERT_VALUES, SCATTER_FORWARD));
}

void add_ghosts(Vec vector) {
  check(VecGhostUpdateBegin(vector, ADD_VALUES, SCATTER_REVERSE));
  check(VecGhostUpdateEnd(vector, ADD_VALUES, SCATTER_REVERSE));
}

} // namespace springproof::mechanics::petsc
