#pragma once

#include "fem_reference/petsc.hpp"

namespace springproof::fem_reference {

/// The owned entries of a ghosted vector and its ghosts behind them, for as long as it lives.
class LocalForm {
 public:
  explicit LocalForm(Vec vector);
  ~LocalForm();
  LocalForm(const LocalForm&) = delete;
  LocalForm& operator=(const LocalForm&) = delete;
  double& operator[](std::size_t local_dof) const { return values_[local_dof]; }
  void set_zero() const;

 private:
  Vec vector_;
  Vec local_ = nullptr;
  double* values_ = nullptr;
};

/// Copies owned values to their ghosts on other ranks.
void update_ghosts(Vec vector);
/// Adds the ghosts to their owners' values.
void add_ghosts(Vec vector);

} // namespace springproof::fem_reference
