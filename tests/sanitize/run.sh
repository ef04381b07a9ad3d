#!/bin/sh
# run.sh SOURCE BUILD PART: under the address and undefined-behaviour sanitizers of clang. The parts:
#   build            builds in BUILD what the others run
#   cases            the unit tests of cases, damaged case files and meshes among them
#   springs          the unit tests of springs, and their check values
#   finite_elements  builds and runs tests of laws, elements, patches, the cube by two other solvers, stability, motions, both backends
#   clients          a thousand mutated answers of a client
#   program          every command, reader and writer, hard cases, kept results, shards
#   damaged_files    some damaged files of every kind
# Fails when a sanitizer finds anything, a test fails or a command ends in another exit status than it should. The libraries (deal.II,
# PETSc, gmsh, VTK, CHOLMOD) are the system's, without sanitizers; what they allocate is watched.
set -eu
source=$1
build=$2
part=$3
command -v clang++ >/dev/null || { echo "clang++ is not installed: nothing was compared"; exit 0; }
export OPENBLAS_NUM_THREADS=1 OMP_THREAD_LIMIT=1
# Leaks are looked for where MPI takes no part (cases, springs): it leaves some, in plugins that it unloads, so that they cannot be named.
# Containers of which a library without sanitizers changes the size look as if they overflowed.
case $part in cases | springs) leaks=1 ;; *) leaks=0 ;; esac
export ASAN_OPTIONS=detect_leaks=$leaks:detect_container_overflow=0:handle_segv=0
export LSAN_OPTIONS="suppressions=$source/tests/sanitize/leaks.txt:print_suppressions=0"
export UBSAN_OPTIONS=print_stacktrace=1

# ends STATUS WORDS...: springproof WORDS ends in that exit status without a word of a sanitizer's.
ends() {
  wanted=$1
  shift
  status=0
  "$build/springproof" "$@" >stdout 2>stderr </dev/null || status=$?
  if [ "$status" -ne "$wanted" ] || grep -E -q 'Sanitizer|runtime error:' stderr; then
    echo "springproof $*: exit status $status, not $wanted"
    tail -n 100 stdout stderr
    exit 1
  fi
}

[ "$part" = build ] || cd "$build"
case $part in
build)
  (cd "$source" && cmake --preset sanitize -B "$build") >&2
  cmake --build "$build" --target springproof springproof_cases_tests springproof_msm_tests springproof_clients_tests >&2 ;;
cases)
  SPRINGPROOF_DAMAGED_FILES=100 ./springproof_cases_tests "~[verification]~[release]~[little_memory]" ;;
springs)
  ./springproof_msm_tests "~[verification]~[release]~[little_memory]"
  ./springproof_msm_tests "-#" "[#model_test][verification]" ;;
finite_elements)
  cmake --build . --target springproof_fem_reference_tests >&2
  ./springproof_fem_reference_tests "-#" \
    "~[ranks]~[little_memory]~[long]~[release]~[#cook_test]~[#manufactured_test]"
  ./springproof_fem_reference_tests "both backends find the same equilibrium under tension and shear*" ;;
clients)
  ./springproof_clients_tests "a thousand mutated answers*" ;;
program)
  rm -rf program
  mkdir program
  cd program
  # Limits of time are for the release build.
  mkdir hard
  for name in bar_buckling bar_buckling_imperfect disconnected_piece flat_cells mechanism one_step slightly_negative_edge start_inverted \
    torsion_90; do
    sed 's/^max_seconds = .*/max_seconds = 3000/' "$source/cases/hard/$name.toml" >hard/$name.toml
  done
  cp "$source/cases/hard/two_pieces.geo" hard
  ends 0 stress hard/*.toml --out out_hard
  small=$source/cases/thesis/linear_elastic/cube_shear_small.toml
  for twice in solved kept; do ends 0 run --out out_run --peer ccx "$small" "$source/cases/thesis/ogden/cube_shear_small.toml"; done
  ends 0 run --json --msm-displacements out_run/cube-shear-small.vtu "$small"
  ends 0 run --json --interpolate --msm-displacements out_run/cube-shear-small.vtu "$small"
  ends 0 export "$small" --to csv --out out_export
  for template in box layers mesh organ tetrahedra voxels; do
    ends 0 new of_$template --template $template
    ends 0 run of_$template.toml --set fem.accuracy='"none"'
  done
  ends 2 run --set body.cells=[600,600,600] "$small"
  ends 2 run --set 'measure[0].top="near 1 2 3.5"' "$small"
  exact=$source/cases/gates/uniaxial_exact.toml
  ends 0 gate --junit junit.xml --annotate --json "$exact" "$source/cases/gates/small_strain_exact.toml"
  for i in 1 2; do ends 0 gate --shard $i/2 --out shard_$i "$exact" "$source/cases/gates/small_strain_exact.toml"; done
  ends 0 merge shard_1 shard_2 --out merged --junit merged.xml
  ends 0 design --young 0.3 --poisson 0.3 --compare
  ends 0 design --neo-hookean 0.1 --poisson 0.4 --method multi_load --out out_design
  ends 0 eigen --poisson 0.3 --body 2 --out out_eigen
  ends 0 sweep --quick "$source/tests/compare/sweep/tiny.toml" --out out_sweep # one cell by the nonlinear method is a mechanism, a failed row
  ends 0 tables 4.1 --out out_tables ;;
damaged_files)
  LIMIT_SECONDS=300 python3 "$source/tests/faults/mutated_files.py" ./springproof "$source" 6 ;;
esac
