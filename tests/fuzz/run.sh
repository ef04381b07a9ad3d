#!/bin/sh
# run.sh SOURCE BUILD SECONDS: builds the reader of case files with clang, libFuzzer and the sanitizers in BUILD, and feeds it
# damaged case files for so long. Fails at the first crash, leak, undefined behaviour or input that takes above a second; the
# input is left in BUILD. What it has learnt stays in BUILD/corpus for the next run.
set -eu
source=$1
build=$2
seconds=$3
command -v clang++ >/dev/null || { echo "clang++ is not installed: nothing was compared"; exit 0; }
cmake -S "$source/tests/fuzz" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=None >&2
cmake --build "$build" >&2

mkdir -p "$build/corpus"
find "$source/cases" -name '*.toml' -print | while read -r file; do
  cp "$file" "$build/corpus/$(printf '%s' "$file" | tr '/' '_')"
done
cd "$build"
./fuzz_case_reader -max_total_time="$seconds" -timeout=1 -max_len=8192 -print_final_stats=1 -dict="$source/tests/fuzz/case.dict" \
  -seed=20261121 corpus
