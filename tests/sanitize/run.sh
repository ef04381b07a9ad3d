#!/bin/sh
# run.sh SOURCE BUILD: builds the springs' side with sanitizers in BUILD, and runs its unit tests and small hard cases. Fails
# when a sanitizer finds anything, a test fails, or a hard case ends otherwise than it must.
set -eu
source=$1
build=$2
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DSPRINGPROOF_SANITIZE=ON >&2
cmake --build "$build" --target springproof_cases_tests springproof_msm_tests springproof_hard_springs >&2

export OPENBLAS_NUM_THREADS=1
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$source/tests/sanitize/leaks.txt:print_suppressions=0"
"$build/springproof_cases_tests"
"$build/springproof_msm_tests" "~[verification]"
cd "$source/cases/hard"
"$build/springproof_hard_springs" bar_buckling.toml bar_buckling_imperfect.toml disconnected_piece.toml fifty_steps.toml \
  flat_cells.toml flat_cells_linear_method.toml mechanism.toml negative_face_diagonal.toml nu_0499_linear_method.toml \
  one_step.toml single_clamped_node.toml slightly_negative_edge.toml soft_internal.toml start_inverted.toml \
  start_perturbed.toml stiffness_contrast.toml ten_times_large_tensile.toml ten_times_large_torsion.toml torsion_90.toml
