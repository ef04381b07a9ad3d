#pragma once

#include "mechanics/petsc/handles.hpp"

#include <exception>
#include <utility>

namespace springproof::mechanics::petsc {

/// Exceptions of functions that PETSc calls: they must not pass through its C code.
class CallbackErrors {
 public:
  /// For a callback to return: an error code in place of an exception, which is kept.
  template<class Action>
  PetscErrorCode run(const Action& action) noexcept {
    try {
      action();
      return 0;
    } catch (...) {
      error_ = std::current_exception();
      return PETSC_ERR_LIB;
    }
  }

  /// Calls a function of PETSc that calls back.  @throws what a callback threw, else as check()
  template<class Action>
  void call(const Action& action) {
    check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr)); // prints nothing
    const PetscErrorCode code = action();
    check(PetscPopErrorHandler());
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    check(code);
  }

 private:
  std::exception_ptr error_;
};

} // namespace springproof::mechanics::petsc
