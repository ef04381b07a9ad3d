#pragma once

/// How a host of this library, such as the Python module, ends a solve that it no longer wants.
namespace springproof::mechanics {

/// Called between the iterations of every solve of this process, by the thread that solves. What it throws
/// leaves the solver, and must be no std::exception, which would be taken for a failed solve.
using Interruption = void (*)();

/// @param check  null: none
void set_interruption(Interruption check);
void check_interruption();

} // namespace springproof::mechanics
