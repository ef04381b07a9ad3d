#!/bin/sh
# run.sh SOURCE BUILD: builds the readers of cases and the springs' side with sanitizers in BUILD, and runs their unit tests
# (damaged case files among them) and small hard cases. Fails
# when a sanitizer finds anything, a test fails, or a hard case ends otherwise than it must. Some hundred times slower than a
# release build are the cases that need many eigenvalue iterations: they are not among these, nor is a test with too little
# memory, at which the address sanitizer gives up.
set -eu
source=$1
build=$2
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DSPRINGPROOF_SANITIZE=ON >&2
cmake --build "$build" --target springproof_cases_tests springproof_msm_tests springproof_hard_springs >&2

export OPENBLAS_NUM_THREADS=1
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$source/tests/sanitize/leaks.txt:print_suppressions=0"
(cd "$build" && ./springproof_cases_tests "~[verification]~[verification-long]" && ./springproof_msm_tests "~[verification]~[verification-long]~[little_memory]") &
unit_tests=$!
hard_cases=0
(cd "$source/cases/hard" && "$build/springproof_hard_springs" bar_buckling.toml bar_buckling_imperfect.toml \
  disconnected_piece.toml flat_cells.toml mechanism.toml one_step.toml slightly_negative_edge.toml start_inverted.toml \
  torsion_90.toml) || hard_cases=1
wait "$unit_tests"
exit $hard_cases
