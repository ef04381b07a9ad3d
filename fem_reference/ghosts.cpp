#include "fem_reference/ghosts.hpp"

#include <algorithm>

namespace springproof::fem_reference {

LocalForm::LocalForm(Vec vector) : vector_(vector) {
  check(VecGhostGetLocalForm(vector_, &local_));
  check(VecGetArray(local_, &values_));
}

LocalForm::~LocalForm() {
  VecRestoreArray(local_, &values_);
  VecGhostRestoreLocalForm(vector_, &local_);
}

void LocalForm::set_zero() const {
  PetscInt size = 0;
  check(VecGetSize(local_, &size));
  std::fill_n(values_, size, 0.);
}

void update_ghosts(Vec vector) {
  check(VecGhostUpdateBegin(vector, INSERT_VALUES, SCATTER_FORWARD));
  check(VecGhostUpdateEnd(vector, INSERT_VALUES, SCATTER_FORWARD));
}

void add_ghosts(Vec vector) {
  check(VecGhostUpdateBegin(vector, ADD_VALUES, SCATTER_REVERSE));
  check(VecGhostUpdateEnd(vector, ADD_VALUES, SCATTER_REVERSE));
}

} // namespace springproof::fem_reference
